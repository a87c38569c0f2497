// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pthread.h>
#include <sys/types.h>

namespace manycore {

/// A mutex in shared memory that the kernel marks when the thread that owns it ends. The kernel
/// names that thread by its number in its own PID namespace: a thread that is killed while it waits
/// takes the mutex from an owner of the same number in another namespace. So only threads of one
/// process at a time may try to lock it (docs/design/registry_lock.md).
class RobustMutex {
public:
  enum class Outcome { locked, owner_died, timed_out };

  /// Called once, by the creator of the segment.
  void initialize();
  /// Waits at most `timeout_ns`. Throws Error{corrupt} if the word is not a mutex.
  Outcome lock(long timeout_ns);
  void unlock() noexcept;
  /// Thread id of the owner, in its PID namespace; 0 if there is none or it has ended. Thread-safe.
  pid_t owner() const noexcept;
  bool is_locked() const noexcept { return owner() != 0; }
  /// True if a thread may be sleeping until the caller, the owner, unlocks the mutex.
  bool is_waited_for() const noexcept;
  /// Does what the kernel failed to do for an owner that has ended, if `thread` is still the owner.
  void mark_owner_died(pid_t thread) noexcept;
  /// Call after owner_died, once the protected state is repaired.
  void mark_consistent() noexcept;

private:
  pthread_mutex_t mutex_;
};

}  // namespace manycore
