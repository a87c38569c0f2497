// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/subscription/reception_counts.hpp"

#include <algorithm>
#include <chrono>

#include "platform/wall_sleep.hpp"
#include "transport/registry/endpoint_blocks.hpp"

namespace manycore {

void ReceptionCounts::store_taken(uint64_t bytes) noexcept {
  EndpointCounters & counters = entry_.counters;
  counters.messages.store(received_, std::memory_order_relaxed);
  counters.bytes.store(
    counters.bytes.load(std::memory_order_relaxed) + bytes, std::memory_order_relaxed);
}

uint64_t ReceptionCounts::count_taken(uint64_t bytes) noexcept {
  ++received_;
  store_taken(bytes);
  return received_;
}

void ReceptionCounts::count_rejected(uint64_t bytes) noexcept {
  --received_;
  store_taken(-bytes);
  count_lost(1);
}

void ReceptionCounts::count_expired() noexcept {
  entry_.counters.expired.fetch_add(1, std::memory_order_relaxed);
}

/// Adds to both sums whose maximum missed_so_far() returns.
void ReceptionCounts::count_lost(uint64_t count) noexcept {
  entry_.counters.lost.fetch_add(count, std::memory_order_relaxed);
  header_.missed_beside_displaced.fetch_add(count, std::memory_order_relaxed);
}

bool ReceptionCounts::needs_settling() const noexcept {
  return unsettled_ || header_.displaced().hints != settled_displaced_;
}

void ReceptionCounts::note_settled(uint64_t displaced) noexcept {
  unsettled_ = false;
  settled_displaced_ = displaced;
  const EndpointCounters & counters = entry_.counters;
  header_.missed_beside_displaced.store(
    counters.lost.load(std::memory_order_relaxed) +
      counters.superseded.load(std::memory_order_relaxed) - displaced,
    std::memory_order_relaxed);
}

uint64_t ReceptionCounts::superseded() const noexcept {
  return missed_so_far(entry_, header_, header_.displaced().hints).superseded;
}

uint64_t ReceptionCounts::lost() const noexcept {
  // A thread that was woken for a displaced hint has to find it: nothing wakes it again. A popper
  // of this process waits in a pop for nothing but a CPU; only a damaged queue needs more looks.
  constexpr int max_looks = 20'000;
  DisplacedCount displaced = header_.displaced();
  for (int look = 0; !displaced.is_exact && look < max_looks; ++look) {
    wall_sleep_for(std::chrono::microseconds(50));
    displaced = header_.displaced();
  }
  const uint64_t now = missed_so_far(entry_, header_, displaced.hints).lost;
  uint64_t reported = reported_lost_.load(std::memory_order_relaxed);
  while (reported < now && !reported_lost_.compare_exchange_weak(reported, now)) {
  }
  return std::max(reported, now);
}

}  // namespace manycore
