// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <cstdint>

namespace manycore {

/// Which process a pid meant when it was noted: pids are used again, and each PID namespace
/// (container) counts its own.
struct ProcessIdentity {
  pid_t pid = 0;               ///< in its own PID namespace; 0 = none
  uint64_t start_time = 0;     ///< proc(5), starttime: clock ticks since boot
  uint64_t pid_namespace = 0;  ///< inode of /proc/<pid>/ns/pid; 0 = unknown

  static ProcessIdentity own();
  /// False when the pid means another process, or none, to this one.
  bool is_of_this_pid_namespace() const;
  /// Waits until no thread of the process runs any more, at most for `timeout_ms`. For a process of
  /// this PID namespace.
  void wait_for_end(int timeout_ms) const;
};

}  // namespace manycore
