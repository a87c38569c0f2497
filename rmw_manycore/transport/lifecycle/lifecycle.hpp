// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "platform/file_lock.hpp"
#include "platform/lifeline.hpp"
#include "transport/registry/registry.hpp"

namespace manycore {

/// Calls `act` under the join lock, which serialises joining, creating and removing of all
/// platforms of this user; on another thread if the lock has to be waited for (see
/// FileLock::run()). The first owner creates the user directory; the last one that leaves no
/// platform in it removes the directory, unless it is MANYCORE_DIRECTORY. Passes on what `act`
/// throws. Throws Error{permission} if the user directory is not private, and Error{timeout}.
void under_join_lock(const PlatformPaths & paths, const std::function<void()> & act);

uint64_t host_smem_bytes(uint64_t shared_bytes, uint32_t clusters);

/// Profile of a platform without a mapfile: Coolidge's shape, SMEM sized by the file system of the
/// user directory.
Profile host_profile();

/// Creates directory and registry of the platform if they are missing, after removing the files of
/// a dead platform. The caller holds the join lock.
void ensure_platform(
  const PlatformPaths & paths, const Profile & profile,
  const std::vector<TopicConfiguration> & topics);

/// True if any process of the platform lives, receive threads included.
bool is_alive(const PlatformPaths & paths);

/// True if a process of the platform or its configurator lives.
bool is_in_use(Registry & registry);

/// Removes all files of a platform without processes or without lifelines, including those that a
/// killed process left, but not those of a later platform of the same name. False if the platform
/// is in use. The caller holds the join lock.
bool remove_if_unused(Registry & registry);

/// Ends the receive threads and removes all files; returns their paths. The caller holds the
/// join lock.
std::vector<std::string> remove_platform(const PlatformPaths & paths);

/// Marks the platform as removed and wakes all members, which then notice.
void note_removal(Registry & registry) noexcept;

/// Closes the endpoints of dead processes and frees their slots; sweeping::sweep_all() frees the
/// endpoints' memory. Takes the registry lock for each endpoint. Starts with dead processes of
/// `cluster`, so that several reapers do not start with the same process. Returns the number of
/// dead processes.
uint32_t reap_dead(Registry & registry, uint32_t cluster);

/// Frees what killed receive threads had in hand. Takes the registry lock.
void empty_hands_of_receive_threads(Registry & registry);

/// Removes the nodes of a dead or leaving process, which adds no further nodes. The caller holds
/// the registry lock.
void remove_nodes_of(Registry & registry, uint32_t process);

/// Frees the slot of a process without endpoints and nodes, and with an empty hand. The caller
/// holds the registry lock.
void leave_registry(Registry & registry, uint32_t process);

/// Makes the reapers of all clusters except `own` check which processes to watch.
void notify_other_reapers(Registry & registry, uint32_t own);

/// Starts the cluster's receive thread unless it is running, or the platform's files are removed.
/// Throws Error{system} if it cannot be started.
void ensure_receive_thread(const Registry & registry, uint32_t cluster);

}  // namespace manycore
