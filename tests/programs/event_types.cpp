// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// Succeeds if each event of ROS 2 is supported and has a place of its own.

#include "rmw/event.cpp"

int main() {
  constexpr rmw_event_type_t all[] = {
    RMW_EVENT_LIVELINESS_CHANGED,
    RMW_EVENT_REQUESTED_DEADLINE_MISSED,
    RMW_EVENT_REQUESTED_QOS_INCOMPATIBLE,
    RMW_EVENT_MESSAGE_LOST,
    RMW_EVENT_SUBSCRIPTION_INCOMPATIBLE_TYPE,
    RMW_EVENT_SUBSCRIPTION_MATCHED,
    RMW_EVENT_LIVELINESS_LOST,
    RMW_EVENT_OFFERED_DEADLINE_MISSED,
    RMW_EVENT_OFFERED_QOS_INCOMPATIBLE,
    RMW_EVENT_PUBLISHER_INCOMPATIBLE_TYPE,
    RMW_EVENT_PUBLICATION_MATCHED};
  for (const rmw_event_type_t type : all) {
    if (!rmw_event_type_is_supported(type) || type >= rmw_manycore::event_type_slots) {
      return 1;
    }
  }
  return rmw_event_type_is_supported(RMW_EVENT_INVALID) ? 2 : 0;
}
