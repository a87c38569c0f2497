// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rcpputils/scope_exit.hpp"
#include "rmw/common/checks.hpp"
#include "rmw/common/error.hpp"
#include "rmw/get_topic_endpoint_info.h"
#include "rmw/graph/endpoint_info.hpp"
#include "rmw/graph/topic_endpoints.hpp"
#include "rmw/qos/qos.hpp"
#include "rmw/topic_endpoint_info_array.h"

namespace rmw_manycore {
namespace {

using manycore::EndpointInfo;
using manycore::NodeInfo;

void write(
  const EndpointInfo & endpoint, const NodeInfo & node, rcutils_allocator_t & allocator,
  rmw_topic_endpoint_info_t & info) {
  check(rmw_topic_endpoint_info_set_node_name(&info, node.name.c_str(), &allocator));
  check(rmw_topic_endpoint_info_set_node_namespace(&info, node.ns.c_str(), &allocator));
  check(rmw_topic_endpoint_info_set_topic_type(&info, endpoint.type.c_str(), &allocator));
  const rosidl_type_hash_t hash = to_rosidl(endpoint.type_hash);
  check(rmw_topic_endpoint_info_set_topic_type_hash(&info, &hash));
  check(rmw_topic_endpoint_info_set_endpoint_type(
    &info, endpoint.kind == manycore::EndpointKind::publisher ? RMW_ENDPOINT_PUBLISHER
                                                              : RMW_ENDPOINT_SUBSCRIPTION));
  check(rmw_topic_endpoint_info_set_gid(&info, endpoint.gid.data(), endpoint.gid.size()));
  const rmw_qos_profile_t profile = to_rmw(endpoint.qos);
  check(rmw_topic_endpoint_info_set_qos_profile(&info, &profile));
}

void write(
  const std::vector<EndpointInfo> & endpoints, const std::vector<NodeInfo> & nodes,
  rcutils_allocator_t & allocator, rmw_topic_endpoint_info_array_t & result) {
  if (endpoints.empty()) {
    return;
  }
  auto made = rmw_get_zero_initialized_topic_endpoint_info_array();
  check(rmw_topic_endpoint_info_array_init_with_size(&made, endpoints.size(), &allocator));
  auto free_made = rcpputils::make_scope_exit(
    [&] { ignore(rmw_topic_endpoint_info_array_fini(&made, &allocator)); });
  for (size_t i = 0; i < endpoints.size(); ++i) {
    write(endpoints[i], find_node(nodes, endpoints[i].node), allocator, made.info_array[i]);
  }
  free_made.cancel();
  result = made;
}

using Find = std::vector<EndpointInfo> (*)(const Node &, const char *);

rmw_ret_t write_found(
  const rmw_node_t * node, rcutils_allocator_t * allocator, const char * topic_name,
  rmw_topic_endpoint_info_array_t * result, Find find) {
  // Invariants
  MANYCORE_CHECK_HANDLE(node);
  MANYCORE_CHECK_ALLOCATOR(allocator);
  MANYCORE_CHECK_ARGUMENT(topic_name);
  if (rmw_topic_endpoint_info_array_check_zero(result) != RMW_RET_OK) {
    return RMW_RET_INVALID_ARGUMENT;
  }

  // Implementation
  return guarded([&] {
    const Node & asking = Node::of(node);
    write(find(asking, topic_name), asking.process().graph().nodes(), *allocator, *result);
    return RMW_RET_OK;
  });
}

}  // namespace
}  // namespace rmw_manycore

// Names are not mangled, so `no_mangle` has no effect.

rmw_ret_t rmw_get_publishers_info_by_topic(
  const rmw_node_t * node, rcutils_allocator_t * allocator, const char * topic_name,
  bool /*no_mangle*/, rmw_topic_endpoint_info_array_t * publishers_info) {
  return rmw_manycore::write_found(
    node, allocator, topic_name, publishers_info, rmw_manycore::publishers_of);
}

rmw_ret_t rmw_get_subscriptions_info_by_topic(
  const rmw_node_t * node, rcutils_allocator_t * allocator, const char * topic_name,
  bool /*no_mangle*/, rmw_topic_endpoint_info_array_t * subscriptions_info) {
  return rmw_manycore::write_found(
    node, allocator, topic_name, subscriptions_info, rmw_manycore::subscriptions_of);
}
