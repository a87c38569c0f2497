// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <mutex>

#include "transport/layout/endpoint.hpp"

namespace manycore {

/// The publisher's side of MANUAL_BY_TOPIC liveliness with a lease: stores the last assertion where
/// subscriptions read it, and counts how often the lease ran out. Needs no timer: both are
/// functions of the clock. Thread-safe.
class ManualLiveliness {
public:
  static constexpr int64_t never = 0;

  /// `asserted_ns` is the last assertion, CLOCK_MONOTONIC, in shared memory; `lease_ns` is the
  /// publisher's lease.
  ManualLiveliness(std::atomic<int64_t> & asserted_ns, int64_t lease_ns) noexcept
  : asserted_ns_(asserted_ns), lease_ns_(lease_ns) {}

  /// True if the publisher was not alive before, so subscriptions must be notified.
  bool assert_now() noexcept;
  /// How often the lease ran out: 0 before the first assertion, then at most once per assertion.
  TimedCount lost() const noexcept;

private:
  bool ran_out(int64_t asserted_ns) const noexcept;

  std::atomic<int64_t> & asserted_ns_;
  const int64_t lease_ns_;
  mutable std::mutex mutex_;
  uint64_t lost_ = 0;
};

}  // namespace manycore
