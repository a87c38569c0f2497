// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "rmw/common/checks.hpp"
#include "rmw/common/error.hpp"
#include "rmw/common/names.hpp"
#include "rmw/context/node.hpp"
#include "rmw/get_node_info_and_types.h"
#include "rmw/graph/names_and_types.hpp"

namespace rmw_manycore {
namespace {

using manycore::EndpointInfo;
using manycore::EndpointKind;
using manycore::EndpointRole;
using manycore::NodeInfo;

/// Handles of all nodes with this name; ROS allows several.
std::set<uint32_t> find_nodes(
  const std::vector<NodeInfo> & nodes, const char * name, const char * ns) {
  std::set<uint32_t> found;
  for (const NodeInfo & node : nodes) {
    if (node.name == name && node.ns == ns) {
      found.insert(node.handle);
    }
  }
  return found;
}

template<typename Predicate>
rmw_ret_t write_of_node(
  const rmw_node_t * node, rcutils_allocator_t * allocator, const char * node_name,
  const char * node_namespace, rmw_names_and_types_t * result, Predicate && wanted) {
  // Invariants
  MANYCORE_CHECK_HANDLE(node);
  MANYCORE_CHECK_ALLOCATOR(allocator);
  MANYCORE_CHECK_ARGUMENT(node_name);
  MANYCORE_CHECK_ARGUMENT(node_namespace);
  MANYCORE_CHECK_ZERO_NAMES_AND_TYPES(result);

  // Implementation
  return guarded([&] {
    check_node_name(node_name);
    check_namespace(node_namespace);
    const manycore::Graph & graph = Node::of(node).process().graph();
    const std::set<uint32_t> nodes = find_nodes(graph.nodes(), node_name, node_namespace);
    if (nodes.empty()) {
      RMW_SET_ERROR_MSG_WITH_FORMAT_STRING(
        "there is no node '%s' in namespace '%s'", node_name, node_namespace);
      return RMW_RET_NODE_NAME_NON_EXISTENT;
    }
    const auto found = names_and_types(graph.endpoints(), [&](const EndpointInfo & endpoint) {
      return nodes.count(endpoint.node) != 0 && wanted(endpoint);
    });
    write(found, *allocator, *result);
    return RMW_RET_OK;
  });
}

}  // namespace
}  // namespace rmw_manycore

using rmw_manycore::EndpointInfo;
using rmw_manycore::EndpointKind;
using rmw_manycore::EndpointRole;
using rmw_manycore::write_of_node;

rmw_ret_t rmw_get_subscriber_names_and_types_by_node(
  const rmw_node_t * node, rcutils_allocator_t * allocator, const char * node_name,
  const char * node_namespace, bool no_demangle, rmw_names_and_types_t * topic_names_and_types) {
  return write_of_node(
    node, allocator, node_name, node_namespace, topic_names_and_types,
    [&](const EndpointInfo & endpoint) {
      return endpoint.kind == EndpointKind::subscription &&
             rmw_manycore::is_shown(endpoint, no_demangle);
    });
}

rmw_ret_t rmw_get_publisher_names_and_types_by_node(
  const rmw_node_t * node, rcutils_allocator_t * allocator, const char * node_name,
  const char * node_namespace, bool no_demangle, rmw_names_and_types_t * topic_names_and_types) {
  return write_of_node(
    node, allocator, node_name, node_namespace, topic_names_and_types,
    [&](const EndpointInfo & endpoint) {
      return endpoint.kind == EndpointKind::publisher &&
             rmw_manycore::is_shown(endpoint, no_demangle);
    });
}

rmw_ret_t rmw_get_service_names_and_types_by_node(
  const rmw_node_t * node, rcutils_allocator_t * allocator, const char * node_name,
  const char * node_namespace, rmw_names_and_types_t * service_names_and_types) {
  return write_of_node(
    node, allocator, node_name, node_namespace, service_names_and_types,
    [](const EndpointInfo & endpoint) {
      return endpoint.kind == EndpointKind::subscription && endpoint.role == EndpointRole::request;
    });
}

rmw_ret_t rmw_get_client_names_and_types_by_node(
  const rmw_node_t * node, rcutils_allocator_t * allocator, const char * node_name,
  const char * node_namespace, rmw_names_and_types_t * service_names_and_types) {
  return write_of_node(
    node, allocator, node_name, node_namespace, service_names_and_types,
    [](const EndpointInfo & endpoint) {
      return endpoint.kind == EndpointKind::subscription && endpoint.role == EndpointRole::reply;
    });
}
