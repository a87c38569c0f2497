// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <atomic>
#include <map>
#include <thread>

#include "platform/file_descriptor.hpp"
#include "transport/registry/registry.hpp"

namespace manycore {

/// The second thread of a receive-thread process: sleeps on the pidfds of its cluster's processes
/// and of the other clusters' receive threads; closes what the dead left behind.
class Reaper {
public:
  Reaper(Registry & registry, uint32_t cluster);
  ~Reaper();
  Reaper(const Reaper &) = delete;
  Reaper & operator=(const Reaper &) = delete;

  /// Somebody joined: look whom to watch. Any thread.
  void look_again() noexcept;

private:
  void run() noexcept;
  /// Each returns how long to wait for the next end before trying again.
  int try_to_reap() noexcept;
  int try_to_end(int patience_ms) noexcept;
  /// True when a member was dead.
  bool watch_and_reap();
  void watch_members();
  bool is_ours(uint32_t cluster) const;
  void watch(uint32_t line);
  /// False when no descriptor is left.
  bool watch_end_of(pid_t pid);
  int patience_ms() const noexcept;
  /// True when one of those watched has ended; false when there is another reason to look, or none.
  bool wait_for_end(int timeout_ms);

  Registry & registry_;
  uint32_t cluster_;
  FileDescriptor poll_;   ///< epoll
  FileDescriptor event_;  ///< eventfd: look again
  FileDescriptor files_;  ///< inotify: files of the platform are gone
  std::map<pid_t, FileDescriptor> watched_;
  bool some_unwatched_ = false;  ///< in other PID namespaces, or no descriptor was left
  bool is_closing_ = false;  ///< something could not be freed yet, and nobody tells when it can be
  bool graph_may_have_changed_ = true;
  bool somebody_ended_ = true;  ///< perhaps all, before this receive thread was started
  std::atomic<bool> running_{true};
  std::thread thread_;
};

/// Ends this receive-thread process, and the platform with it, if no process uses the platform any
/// more.
void exit_if_unused(Registry & registry);

}  // namespace manycore
