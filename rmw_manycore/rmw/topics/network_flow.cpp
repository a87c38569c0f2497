// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/topics/network_flow.hpp"

#include "platform/error.hpp"
#include "rmw/common/checks.hpp"
#include "rmw/get_network_flow_endpoints.h"

namespace {

template<typename Handle>
rmw_ret_t refuse(
  const Handle * handle, rcutils_allocator_t * allocator,
  rmw_network_flow_endpoint_array_t * network_flow_endpoint_array) {
  MANYCORE_CHECK_HANDLE(handle);
  MANYCORE_CHECK_ARGUMENT(allocator);
  MANYCORE_CHECK_ARGUMENT(network_flow_endpoint_array);
  RMW_SET_ERROR_MSG("rmw_manycore uses no network, so there are no network flow endpoints");
  return RMW_RET_UNSUPPORTED;
}

}  // namespace

void rmw_manycore::check_network_flow(rmw_unique_network_flow_endpoints_requirement_t requirement) {
  if (requirement == RMW_UNIQUE_NETWORK_FLOW_ENDPOINTS_STRICTLY_REQUIRED) {
    throw manycore::Error(
      manycore::ErrorCode::unsupported,
      "unique network flow endpoints are not supported: rmw_manycore uses no network");
  }
}

rmw_ret_t rmw_publisher_get_network_flow_endpoints(
  const rmw_publisher_t * publisher, rcutils_allocator_t * allocator,
  rmw_network_flow_endpoint_array_t * network_flow_endpoint_array) {
  return refuse(publisher, allocator, network_flow_endpoint_array);
}

rmw_ret_t rmw_subscription_get_network_flow_endpoints(
  const rmw_subscription_t * subscription, rcutils_allocator_t * allocator,
  rmw_network_flow_endpoint_array_t * network_flow_endpoint_array) {
  return refuse(subscription, allocator, network_flow_endpoint_array);
}
