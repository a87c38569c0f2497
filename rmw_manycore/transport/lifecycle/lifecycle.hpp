// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "platform/file_lock.hpp"
#include "platform/lifeline.hpp"
#include "transport/registry/registry.hpp"

namespace manycore {

/// Serialises joining and leaving of all platforms of this user, while alive. The user directory
/// comes with its first holder and goes with the last one that leaves no platform in it, unless it
/// is a chosen one.
class JoinLock {
public:
  /// Throws Error{permission} when the user directory is not private.
  explicit JoinLock(const PlatformPaths & paths);
  ~JoinLock();
  JoinLock(const JoinLock &) = delete;
  JoinLock & operator=(const JoinLock &) = delete;

private:
  PlatformPaths paths_;
  std::optional<FileLock> lock_;
};

uint64_t host_smem_bytes(uint64_t shared_bytes, uint32_t clusters);

/// Sizes for a platform that nobody configured: Coolidge's shape, SMEM from what the file
/// system of the user directory holds.
Profile host_profile();

/// Brings the platform's directory and registry up where they are missing, and wipes what a dead
/// platform left. The caller holds the JoinLock.
void ensure_platform(
  const PlatformPaths & paths, const Profile & profile,
  const std::vector<TopicConfiguration> & topics);

/// True when anything of the platform lives, receive threads included.
bool is_alive(const PlatformPaths & paths);

/// Removes all files of a platform without a process, also what a killed process has left of them;
/// but not a later platform of its name. False when it is used. The caller holds the JoinLock.
bool remove_if_unused(Registry & registry);

/// Sends the receive threads home and removes all files. The caller holds the JoinLock. Returns the
/// paths.
std::vector<std::string> remove_platform(const PlatformPaths & paths);

/// Tells all members that the files are gone, and wakes them to notice.
void note_removal(Registry & registry) noexcept;

/// Closes what dead processes left behind, and makes their places free; their endpoints' memory
/// goes with sweeping::sweep_all(). Takes the registry lock anew for each turn. The dead of the
/// caller's `cluster` go first: several reapers then do not all begin with the same process.
/// Returns the number of the dead.
uint32_t reap_dead(Registry & registry, uint32_t cluster);

/// Under the registry lock: gives back the place of a process whose endpoints are closed, and its
/// nodes.
void leave_registry(Registry & registry, uint32_t process);

/// Has the reapers of all clusters but `own` look whom to watch.
void tell_other_reapers(Registry & registry, uint32_t own);

/// Starts the cluster's receive thread unless it lives. Throws Error{system} when it cannot be
/// started.
void ensure_receive_thread(const PlatformPaths & paths, uint32_t cluster);

}  // namespace manycore
