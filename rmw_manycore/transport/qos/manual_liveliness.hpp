// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <mutex>

#include "transport/layout/endpoint.hpp"

namespace manycore {

/// The publisher's side of MANUAL_BY_TOPIC liveliness with a lease: remembers the last assertion
/// where subscriptions read it, and counts how often the lease ran out. Without a timer: both are
/// functions of the clock. Thread-safe.
class ManualLiveliness {
public:
  static constexpr int64_t never = 0;

  /// `asserted_ns`: CLOCK_MONOTONIC of the last assertion, in shared memory.
  ManualLiveliness(std::atomic<int64_t> & asserted_ns, int64_t lease_ns) noexcept
  : asserted_ns_(asserted_ns), lease_ns_(lease_ns) {}

  /// True when this brought the publisher (back) to life, so that subscriptions have something to
  /// hear of.
  bool assert_now() noexcept;
  /// How often the lease ran out; nothing before the first assertion, then once until the next one.
  TimedCount lost() const noexcept;

private:
  bool ran_out(int64_t asserted_ns) const noexcept;

  std::atomic<int64_t> & asserted_ns_;
  const int64_t lease_ns_;
  mutable std::mutex mutex_;
  uint64_t lost_ = 0;
};

}  // namespace manycore
