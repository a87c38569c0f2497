// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>

#include "platform/robust_mutex.hpp"

namespace manycore {

/// What a thread occupies while it waits for a RecoverableMutex and owns it. A seat belongs to one
/// process at a time, so the kernel can tell when the thread that occupies it has ended, whatever
/// the PID namespaces.
struct LockSeat {
  RobustMutex occupied;
  uint64_t takes;          ///< tickets drawn from this seat; changed by the thread that occupies it
  uint64_t pid_namespace;  ///< of that thread
  uint64_t reserved;
};
static_assert(sizeof(LockSeat) == 64);

/// A mutex in shared memory whose word, the ticket, names the seat of its owner and counts the
/// takes from that seat, so no ticket occurs twice. A thread that finds the owner ended takes the
/// mutex over and learns of it. Works across PID namespaces. Model: docs/model/registry_lock.pml.
class RecoverableMutex {
public:
  enum class Outcome { locked, owner_died, timed_out };

  /// Says whether the thread that took the mutex from a seat has ended. The seat may not exist: a
  /// damaged ticket names any.
  using HasEnded = std::function<bool(uint32_t seat)>;

  /// Waits at most `timeout_ns`. The calling thread occupies the seat, until after unlock(). Passes
  /// on what `has_ended` throws.
  Outcome lock(uint32_t seat, LockSeat & own, const HasEnded & has_ended, long timeout_ns);
  void unlock(uint32_t seat) noexcept;
  /// The owner's seat; empty if the mutex is free. Thread-safe.
  std::optional<uint32_t> owner() const noexcept;
  /// True if a thread may be sleeping until the caller, the owner, unlocks the mutex.
  bool is_waited_for() const noexcept;

private:
  bool try_take(uint64_t & seen, uint64_t ticket) noexcept;
  bool announce_waiter(uint64_t & seen) noexcept;
  void sleep(uint64_t seen, int64_t until_ns) noexcept;

  std::atomic<uint64_t> ticket_;  ///< 0 = free
};
static_assert(sizeof(RecoverableMutex) == 8 && std::atomic<uint64_t>::is_always_lock_free);

}  // namespace manycore
