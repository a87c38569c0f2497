// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/registry/endpoint_blocks.hpp"

#include <algorithm>

namespace manycore {

bool keeps_newest_only(const EndpointEntry & subscription) noexcept {
  return subscription.role == EndpointRole::topic &&
         subscription.qos.history == History::keep_last && subscription.qos.depth == 1;
}

Missed missed_so_far(
  const EndpointEntry & entry, const SubscriptionHeader & header, uint64_t displaced) noexcept {
  Missed missed{
    entry.counters.lost.load(std::memory_order_relaxed),
    entry.counters.superseded.load(std::memory_order_relaxed)};
  const uint64_t beside = header.missed_beside_displaced.load(std::memory_order_relaxed);
  // Negative after a displaced double, and while `displaced` is older than the others or not exact.
  // All sums wrap.
  const auto more = static_cast<int64_t>(displaced + beside - missed.lost - missed.superseded);
  (keeps_newest_only(entry) ? missed.superseded : missed.lost) +=
    static_cast<uint64_t>(std::max<int64_t>(more, 0));
  return missed;
}

void notify_watchers(Registry & registry, const SubscriptionHeader & header) {
  const uint32_t process = header.process.load(std::memory_order_relaxed);
  if (registry.processes().is_live(process)) {
    registry.processes()[process].wake.notify_arrival(
      header.watchers, header.endpoint.load(std::memory_order_relaxed));
  }
}

void notify_event_watchers(Registry & registry, uint32_t process) {
  if (registry.processes().is_live(process)) {
    registry.processes()[process].wake.notify_events();
  }
}

}  // namespace manycore
