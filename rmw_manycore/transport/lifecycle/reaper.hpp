// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <atomic>
#include <bitset>
#include <map>
#include <mutex>
#include <thread>

#include "platform/file_descriptor.hpp"
#include "transport/registry/registry.hpp"

namespace manycore {

/// Second thread of a receive-thread process: waits on the pidfds of its cluster's processes and of
/// the other clusters' receive threads, and frees what dead processes left.
class Reaper {
public:
  Reaper(Registry & registry, uint32_t cluster);
  ~Reaper();
  Reaper(const Reaper &) = delete;
  Reaper & operator=(const Reaper &) = delete;

  /// Makes the reaper watch a process that joins, or check all processes if `process` is `nothing`.
  /// Thread-safe.
  void rescan(uint32_t process = nothing) noexcept;

private:
  void run() noexcept;
  /// Each returns the timeout in ms after which to try again.
  int try_to_reap() noexcept;
  int try_to_end(int timeout_ms) noexcept;
  /// True if a member was dead.
  bool watch_and_reap();
  void watch_members();
  void wait_for_joining();
  bool watch_one(uint32_t process);
  /// Returns false if all processes must be checked.
  bool watch_joined() noexcept;
  bool is_ours(uint32_t cluster) const;
  void watch(uint32_t line);
  /// False if no file descriptor is left.
  bool watch_end_of(pid_t pid);
  void release_abandoned(pid_t pid);
  int timeout_ms() const noexcept;
  /// True if a watched process ended or files were removed; false on other events and on timeout.
  bool wait_for_end(int timeout_ms);

  Registry & registry_;
  uint32_t cluster_;
  FileDescriptor poll_;   ///< epoll
  FileDescriptor event_;  ///< eventfd: rescan() was called
  FileDescriptor files_;  ///< inotify: files of the platform were removed
  std::map<pid_t, FileDescriptor> watched_;
  bool some_unwatched_ = false;  ///< in another PID namespace, or no file descriptor was left
  bool is_any_in_use_ = false;   ///< some memory cannot be freed yet: no event signals when it can
  std::mutex mutex_;             ///< guards the following two
  std::bitset<process_capacity> joined_;  ///< slots passed to rescan(), not watched yet
  bool must_check_all_ = true;
  bool graph_may_have_changed_ = true;
  /// Initially true: all members may have died before this receive thread started.
  bool some_ended_ = true;
  std::atomic<bool> running_{true};
  std::thread thread_;
};

/// Ends this receive-thread process, and removes the platform, if no process uses the platform.
void exit_if_unused(Registry & registry);

}  // namespace manycore
