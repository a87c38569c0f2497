// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>

#include "platform/robust_mutex.hpp"

namespace manycore {

/// What a thread holds while it waits for a RecoverableMutex and owns it. A badge belongs to one
/// process at a time, so the kernel can tell when the thread that holds it has ended, whatever
/// the PID namespaces.
struct LockBadge {
  RobustMutex held;
  uint64_t takes;          ///< tickets drawn from this badge; changed by the thread that holds it
  uint64_t pid_namespace;  ///< of that thread
  uint64_t reserved;
};
static_assert(sizeof(LockBadge) == 64);

/// A mutex in shared memory whose word, the ticket, names the badge of its owner and counts the
/// takes from that badge, so no ticket occurs twice. A thread that finds the owner ended takes the
/// mutex over and learns of it. Works across PID namespaces. Model: docs/model/registry_lock.pml.
class RecoverableMutex {
public:
  enum class Outcome { locked, owner_died, timed_out };

  /// Reports whether the thread that took the mutex from a badge has ended. The badge may not
  /// exist: a damaged ticket names any.
  using HasEnded = std::function<bool(uint32_t badge)>;

  /// Waits at most `timeout_ns`. The calling thread holds the badge, until after unlock(). Passes
  /// on what `has_ended` throws.
  Outcome lock(uint32_t badge, LockBadge & own, const HasEnded & has_ended, long timeout_ns);
  void unlock(uint32_t badge) noexcept;
  /// The owner's badge; empty if the mutex is free. Thread-safe.
  std::optional<uint32_t> owner() const noexcept;
  /// True if a thread may be sleeping until the caller, the owner, unlocks the mutex.
  bool is_waited_for() const noexcept;

private:
  bool try_take(uint64_t & seen, uint64_t ticket) noexcept;
  bool spin(uint64_t & seen, uint64_t ticket) noexcept;
  bool announce_waiter(uint64_t & seen) noexcept;
  void sleep(uint64_t seen, int64_t until_ns) noexcept;

  std::atomic<uint64_t> ticket_;  ///< 0 = free
};
static_assert(sizeof(RecoverableMutex) == 8 && std::atomic<uint64_t>::is_always_lock_free);

}  // namespace manycore
