// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/common/checks.hpp"
#include "rmw/common/error.hpp"
#include "rmw/rmw.h"
#include "rmw/services/client.hpp"
#include "rmw/services/service.hpp"
#include "rmw/topics/subscription.hpp"

namespace {

rmw_ret_t set_callback(
  rmw_manycore::Inbox & inbox, rmw_event_callback_t callback, const void * user_data) {
  return rmw_manycore::guarded([&] {
    inbox.on_arrival().set(callback, user_data);
    return RMW_RET_OK;
  });
}

}  // namespace

rmw_ret_t rmw_subscription_set_on_new_message_callback(
  rmw_subscription_t * subscription, rmw_event_callback_t callback, const void * user_data) {
  // Invariants
  MANYCORE_CHECK_HANDLE(subscription);

  // Implementation
  return set_callback(rmw_manycore::Subscription::of(subscription).inbox(), callback, user_data);
}

rmw_ret_t rmw_service_set_on_new_request_callback(
  rmw_service_t * service, rmw_event_callback_t callback, const void * user_data) {
  // Invariants
  MANYCORE_CHECK_HANDLE(service);

  // Implementation
  return set_callback(rmw_manycore::Service::of(service).requests(), callback, user_data);
}

rmw_ret_t rmw_client_set_on_new_response_callback(
  rmw_client_t * client, rmw_event_callback_t callback, const void * user_data) {
  // Invariants
  MANYCORE_CHECK_HANDLE(client);

  // Implementation
  return set_callback(rmw_manycore::Client::of(client).replies(), callback, user_data);
}
