// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// Part of Timekeeper: time that stands at the request of the user, who looks at what the nodes do.

#include "transport/timekeeping/timekeeper.hpp"

namespace manycore {

using virtual_time::never_ns;

void Timekeeper::hold(const std::string & why) {
  is_held_ = true;
  is_single_ = false;
  stop_ns_ = never_ns;
  stop_topic_.clear();
  const int64_t passed_ns = page_.now_ns.load() - virtual_time::start_ns;
  report("held", std::to_string(passed_ns) + " " + why);
}

void Timekeeper::resume(int64_t duration_ns, const std::string & topic) {
  is_held_ = false;
  is_single_ = duration_ns < 0;
  stop_ns_ = duration_ns > 0 ? page_.now_ns.load() + duration_ns : never_ns;
  stop_topic_ = topic;
  published_before_ = published();
}

void Timekeeper::hold_if_published() {
  if (stop_topic_.empty()) {
    return;
  }
  const uint64_t now = published();
  if (now > published_before_) {
    hold(stop_topic_ + " was published");
  } else {
    published_before_ = now;  // less: one of its publishers has gone
  }
}

/// Messages on the topic that time stops at, of the publishers that are there.
uint64_t Timekeeper::published() const {
  uint64_t sum = 0;
  const auto & endpoints = registry_.endpoints();
  for (uint32_t slot = 0; slot < endpoints.high_water(); ++slot) {
    const EndpointEntry & entry = endpoints[slot];
    if (
      endpoints.is_live(slot) && entry.kind == EndpointKind::publisher &&
      entry.topic == stop_topic_) {
      sum += entry.counters.messages.load(std::memory_order_relaxed);
    }
  }
  return sum;
}

}  // namespace manycore
