// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "rmw/event.h"

namespace rmw_manycore {

// By name: whether RMW_EVENT_INVALID comes first or last depends on the release of rmw.

constexpr std::array subscription_events{
  RMW_EVENT_LIVELINESS_CHANGED,
  RMW_EVENT_REQUESTED_DEADLINE_MISSED,
  RMW_EVENT_REQUESTED_QOS_INCOMPATIBLE,
  RMW_EVENT_MESSAGE_LOST,
  RMW_EVENT_SUBSCRIPTION_INCOMPATIBLE_TYPE,
  RMW_EVENT_SUBSCRIPTION_MATCHED};

constexpr std::array publisher_events{
  RMW_EVENT_LIVELINESS_LOST, RMW_EVENT_OFFERED_DEADLINE_MISSED, RMW_EVENT_OFFERED_QOS_INCOMPATIBLE,
  RMW_EVENT_PUBLISHER_INCOMPATIBLE_TYPE, RMW_EVENT_PUBLICATION_MATCHED};

template<size_t Count>
constexpr bool contains(
  const std::array<rmw_event_type_t, Count> & events, rmw_event_type_t type) noexcept {
  for (const rmw_event_type_t event : events) {
    if (event == type) {
      return true;
    }
  }
  return false;
}

/// Size of an array that is indexed by the type of an event.
constexpr size_t event_type_slots = [] {
  size_t last = 0;
  for (const rmw_event_type_t event : subscription_events) {
    last = std::max(last, static_cast<size_t>(event));
  }
  for (const rmw_event_type_t event : publisher_events) {
    last = std::max(last, static_cast<size_t>(event));
  }
  return last + 1;
}();

}  // namespace rmw_manycore
