// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pthread.h>
#include <sys/types.h>

namespace manycore {

/// A mutex in shared memory whose next owner learns that the last one died holding it. Never taken
/// on the data path.
class RobustMutex {
public:
  enum class Outcome { locked, owner_died };

  /// Called once, by the creator of the segment.
  void initialize();
  /// Throws Error{timeout} after `timeout_ns`, describing the owner's state, and Error{corrupt} if
  /// the word is not a mutex.
  Outcome lock(long timeout_ns);
  void unlock() noexcept;
  /// Thread id of the owner; 0 if there is none or it is dead. Thread-safe.
  pid_t owner() const noexcept;
  bool is_locked() const noexcept { return owner() != 0; }
  /// True if a thread may be sleeping until the caller, the owner, unlocks the mutex.
  bool is_waited_for() const noexcept;
  /// Call after owner_died, once the protected state is repaired.
  void mark_consistent() noexcept;

private:
  pthread_mutex_t mutex_;
};

}  // namespace manycore
