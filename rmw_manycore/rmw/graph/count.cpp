// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/common/checks.hpp"
#include "rmw/common/error.hpp"
#include "rmw/common/names.hpp"
#include "rmw/graph/topic_endpoints.hpp"
#include "rmw/rmw.h"

using manycore::EndpointKind;
using manycore::EndpointRole;

namespace {

rmw_ret_t count_endpoints(
  const rmw_node_t * node, const char * name, size_t * count, EndpointKind kind,
  EndpointRole role) {
  // Invariants
  MANYCORE_CHECK_HANDLE(node);
  MANYCORE_CHECK_ARGUMENT(name);
  MANYCORE_CHECK_ARGUMENT(count);

  // Implementation
  return rmw_manycore::guarded([&] {
    rmw_manycore::check_full_name(name);
    *count = rmw_manycore::endpoints_of(rmw_manycore::Node::of(node), name, kind, role).size();
    return RMW_RET_OK;
  });
}

}  // namespace

rmw_ret_t rmw_count_publishers(const rmw_node_t * node, const char * topic_name, size_t * count) {
  return count_endpoints(node, topic_name, count, EndpointKind::publisher, EndpointRole::topic);
}

rmw_ret_t rmw_count_subscribers(const rmw_node_t * node, const char * topic_name, size_t * count) {
  return count_endpoints(node, topic_name, count, EndpointKind::subscription, EndpointRole::topic);
}

rmw_ret_t rmw_count_clients(const rmw_node_t * node, const char * service_name, size_t * count) {
  return count_endpoints(
    node, service_name, count, EndpointKind::subscription, EndpointRole::reply);
}

rmw_ret_t rmw_count_services(const rmw_node_t * node, const char * service_name, size_t * count) {
  return count_endpoints(
    node, service_name, count, EndpointKind::subscription, EndpointRole::request);
}
