// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>

#include "transport/layout/endpoint.hpp"
#include "virtual_time/door.hpp"

namespace manycore {

/// Counts periods without a message (DDS DEADLINE) in a single word and without a timer: missed(t)
/// = (t - origin) / period. A message moves the origin such that the count is unchanged and a new
/// period begins. The state is one word, so a process may be killed at any instruction of touch().
/// All arithmetic is unsigned: a damaged word yields a wrong count, never undefined behaviour.
class DeadlineClock {
public:
  static constexpr uint64_t not_started = INT64_MAX;  ///< no message yet: no deadline can be missed

  /// Periods missed at `now_ns`. Requires origin_ns <= now_ns and period_ns > 0.
  static constexpr uint64_t missed_at(uint64_t origin_ns, uint64_t now_ns, uint64_t period_ns) {
    return origin_ns == not_started ? 0 : (now_ns - origin_ns) / period_ns;
  }
  /// Origin after a message at `now_ns`.
  static constexpr uint64_t moved(uint64_t origin_ns, uint64_t now_ns, uint64_t period_ns) {
    return now_ns - missed_at(origin_ns, now_ns, period_ns) * period_ns;
  }

  void reset() noexcept { origin_ns_.store(not_started, std::memory_order_relaxed); }

  /// Records a message. Returns true for the first message, before which no deadline was due.
  /// The clock is read after the origin: an origin in the future would lose a miss. The exchange is
  /// seq_cst and precedes the caller's load of the event watchers; a waiting thread registers as a
  /// watcher before it loads the origin, so one of the two sees the other.
  bool touch(int64_t period_ns) noexcept {
    uint64_t origin_ns = origin_ns_.load(std::memory_order_acquire);
    while (period_ns > 0 && !origin_ns_.compare_exchange_weak(
                              origin_ns, moved(origin_ns, now(), static_cast<uint64_t>(period_ns)),
                              std::memory_order_seq_cst)) {
    }
    return origin_ns == not_started;
  }

  /// Periods missed so far, and when the next one ends.
  TimedCount missed(int64_t period_ns) const noexcept {
    const uint64_t origin_ns = origin_ns_.load(std::memory_order_seq_cst);
    if (origin_ns == not_started || period_ns <= 0) {
      return {};
    }
    const auto period = static_cast<uint64_t>(period_ns);
    const uint64_t missed = missed_at(origin_ns, now(), period);
    const uint64_t due_ns = origin_ns + missed * period + period;
    return {missed, static_cast<int64_t>(std::min<uint64_t>(due_ns, infinite_ns))};
  }

private:
  static uint64_t now() noexcept { return static_cast<uint64_t>(qos_now_ns()); }

  std::atomic<uint64_t> origin_ns_;  ///< CLOCK_MONOTONIC; may wrap below zero
};
static_assert(sizeof(DeadlineClock) == 8 && std::atomic<uint64_t>::is_always_lock_free);

}  // namespace manycore
