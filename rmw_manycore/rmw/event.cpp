// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/event.h"

#include "rmw/common/checks.hpp"
#include "rmw/common/error.hpp"
#include "rmw/events/endpoint_events.hpp"
#include "rmw/rmw.h"
#include "rmw/topics/publisher.hpp"
#include "rmw/topics/subscription.hpp"

namespace rmw_manycore {
namespace {

rmw_ret_t initialize(
  rmw_event_t * event, EndpointEvents & events, rmw_event_type_t type, bool of_publisher) {
  if (!(of_publisher ? contains(publisher_events, type) : contains(subscription_events, type))) {
    RMW_SET_ERROR_MSG_WITH_FORMAT_STRING(
      "event type %d is not supported by rmw_manycore on a %s", static_cast<int>(type),
      of_publisher ? "publisher" : "subscription");
    return RMW_RET_UNSUPPORTED;
  }
  if (event->implementation_identifier != nullptr) {
    RMW_SET_ERROR_MSG("expected a zero-initialized event");
    return RMW_RET_INVALID_ARGUMENT;
  }
  event->implementation_identifier = identifier;
  event->data = &events;
  event->event_type = type;
  return RMW_RET_OK;
}

}  // namespace
}  // namespace rmw_manycore

using rmw_manycore::EndpointEvents;

bool rmw_event_type_is_supported(rmw_event_type_t rmw_event_type) {
  return rmw_manycore::contains(rmw_manycore::subscription_events, rmw_event_type) ||
         rmw_manycore::contains(rmw_manycore::publisher_events, rmw_event_type);
}

rmw_ret_t rmw_publisher_event_init(
  rmw_event_t * rmw_event, const rmw_publisher_t * publisher, rmw_event_type_t event_type) {
  // Invariants
  MANYCORE_CHECK_ARGUMENT(rmw_event);
  MANYCORE_CHECK_HANDLE(publisher);

  // Implementation
  return rmw_manycore::initialize(
    rmw_event, rmw_manycore::Publisher::of(publisher), event_type, true);
}

rmw_ret_t rmw_subscription_event_init(
  rmw_event_t * rmw_event, const rmw_subscription_t * subscription, rmw_event_type_t event_type) {
  // Invariants
  MANYCORE_CHECK_ARGUMENT(rmw_event);
  MANYCORE_CHECK_HANDLE(subscription);

  // Implementation
  return rmw_manycore::initialize(
    rmw_event, rmw_manycore::Subscription::of(subscription), event_type, false);
}

rmw_ret_t rmw_take_event(const rmw_event_t * event_handle, void * event_info, bool * taken) {
  // Invariants
  MANYCORE_CHECK_HANDLE(event_handle);
  MANYCORE_CHECK_ARGUMENT(event_info);
  MANYCORE_CHECK_ARGUMENT(taken);

  // Implementation
  *taken = false;
  return rmw_manycore::guarded([&] {
    static_cast<EndpointEvents *>(event_handle->data)->take(event_handle->event_type, event_info);
    *taken = true;
    return RMW_RET_OK;
  });
}

rmw_ret_t rmw_event_set_callback(
  rmw_event_t * event, rmw_event_callback_t callback, const void * user_data) {
  // Invariants
  MANYCORE_CHECK_HANDLE(event);

  // Implementation
  return rmw_manycore::guarded([&] {
    static_cast<EndpointEvents *>(event->data)
      ->set_callback(event->event_type, callback, user_data);
    return RMW_RET_OK;
  });
}
