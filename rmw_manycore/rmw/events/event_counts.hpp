// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <mutex>

#include "rmw/event.h"
#include "transport/layout/endpoint.hpp"

namespace rmw_manycore {

/// Counts behind one event of an endpoint.
struct EventCounts {
  uint64_t changes = 0;    ///< only rises; the event is ready while it exceeds the reported count
  uint64_t total = 0;      ///< number of occurrences
  uint64_t current = 0;    ///< matched: current matches; liveliness: publishers alive
  uint64_t not_alive = 0;  ///< liveliness: matched publishers not alive
  manycore::QosPolicy last_policy = manycore::QosPolicy::none;  ///< incompatible QoS: the policy
  /// When time alone changes the counts (CLOCK_MONOTONIC).
  int64_t next_due_ns = manycore::infinite_ns;

  static EventCounts of(uint64_t total) { return of(manycore::TimedCount{total}); }
  static EventCounts of(const manycore::TimedCount & count) {
    return {count.total, count.total, count.total, 0, {}, count.next_due_ns};
  }
  static EventCounts of(const manycore::IncompatibleCount & count) {
    return {count.total, count.total, count.total, 0, count.last_policy, manycore::infinite_ns};
  }
  /// `changes` counts matches and their ends.
  static EventCounts of(const manycore::MatchedCount & count) {
    return {
      2 * count.total - count.current, count.total, count.current, 0, {}, manycore::infinite_ns};
  }
};

/// Converts observed liveliness into a count of changes. Thread-safe.
class LivelinessChanges {
public:
  EventCounts observe(const manycore::LivelinessCount & now) {
    const std::lock_guard lock(mutex_);
    if (now.alive != seen_.alive || now.not_alive != seen_.not_alive) {
      ++changes_;
      seen_ = now;
    }
    return {changes_, 0, now.alive, now.not_alive, {}, now.next_due_ns};
  }

private:
  std::mutex mutex_;
  manycore::LivelinessCount seen_;
  uint64_t changes_ = 0;
};

/// Writes the rmw status structure of `type`, from current counts and those reported before.
void fill_status(
  rmw_event_type_t type, const EventCounts & now, const EventCounts & told, void * status);

}  // namespace rmw_manycore
