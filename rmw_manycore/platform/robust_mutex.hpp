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

  /// Once, by the creator of the segment.
  void initialize();
  /// Throws Error{timeout} after `timeout_ns`, whose text says what state the owner is in, and
  /// Error{corrupt} on a word that is no mutex.
  Outcome lock(long timeout_ns);
  void unlock() noexcept;
  /// The thread that locked it; 0 for none or a dead one. Any thread may ask.
  pid_t owner() const noexcept;
  bool is_locked() const noexcept { return owner() != 0; }
  /// True when some thread may sleep until its owner, the caller, unlocks it.
  bool is_waited_for() const noexcept;
  /// After owner_died, once the protected state has been repaired.
  void mark_consistent() noexcept;

private:
  pthread_mutex_t mutex_;
};

}  // namespace manycore
