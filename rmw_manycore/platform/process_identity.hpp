// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <cstdint>

namespace manycore {

/// Identifies a process beyond its pid: pids are reused, and each PID namespace (container) has its
/// own.
struct ProcessIdentity {
  pid_t pid = 0;               ///< in its own PID namespace; 0 = none
  uint64_t start_time = 0;     ///< proc(5), starttime: clock ticks since boot
  uint64_t pid_namespace = 0;  ///< inode of /proc/<pid>/ns/pid; 0 = unknown

  static ProcessIdentity own();
  /// Of a process of this PID namespace; start_time 0 if there is none.
  static ProcessIdentity of(pid_t pid);
  bool operator==(const ProcessIdentity & other) const noexcept {
    return pid == other.pid && start_time == other.start_time &&
           pid_namespace == other.pid_namespace;
  }
  /// False if the pid denotes another process, or none, in this PID namespace.
  bool is_of_this_pid_namespace() const;
  /// Waits at most `timeout_ms` until no thread of the process runs any more. Requires a process of
  /// this PID namespace.
  void wait_for_end(int timeout_ms) const;
};

/// Inode of this process's PID namespace; 0 if there is no /proc.
uint64_t own_pid_namespace();

}  // namespace manycore
