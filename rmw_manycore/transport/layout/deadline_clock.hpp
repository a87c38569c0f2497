// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>

#include "platform/clock.hpp"
#include "transport/layout/endpoint.hpp"

namespace manycore {

/// Counts periods without a message (DDS DEADLINE) in one word, without a timer: missed(t) = (t -
/// origin) / period. A message moves the origin so that the count stays and the next period begins.
/// One word, so any process may be killed at any instruction of a touch(). Unsigned throughout: a
/// damaged word gives a wrong count and nothing worse.
class DeadlineClock {
public:
  static constexpr uint64_t not_started =
    INT64_MAX;  ///< before the first message nothing is missed

  /// Misses at `now_ns`; needs origin <= now_ns and a period above 0.
  static constexpr uint64_t missed_at(uint64_t origin_ns, uint64_t now_ns, uint64_t period_ns) {
    return origin_ns == not_started ? 0 : (now_ns - origin_ns) / period_ns;
  }
  /// The origin after a message at `now_ns`.
  static constexpr uint64_t moved(uint64_t origin_ns, uint64_t now_ns, uint64_t period_ns) {
    return now_ns - missed_at(origin_ns, now_ns, period_ns) * period_ns;
  }

  void reset() noexcept { origin_ns_.store(not_started, std::memory_order_relaxed); }

  /// A message is there; true when it is the first, before which nothing was due. The clock is read
  /// after the origin: an origin in the future would lose a miss. seq_cst, before a look at who
  /// waits for events: he counts himself before he reads the origin.
  bool touch(int64_t period_ns) noexcept {
    uint64_t origin_ns = origin_ns_.load(std::memory_order_acquire);
    while (period_ns > 0 && !origin_ns_.compare_exchange_weak(
                              origin_ns, moved(origin_ns, now(), static_cast<uint64_t>(period_ns)),
                              std::memory_order_seq_cst)) {
    }
    return origin_ns == not_started;
  }

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
  static uint64_t now() noexcept { return static_cast<uint64_t>(monotonic_ns()); }

  std::atomic<uint64_t> origin_ns_;  ///< CLOCK_MONOTONIC; wraps below zero
};
static_assert(sizeof(DeadlineClock) == 8 && std::atomic<uint64_t>::is_always_lock_free);

}  // namespace manycore
