// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/common/checks.hpp"
#include "rmw/common/error.hpp"
#include "rmw/context/node.hpp"
#include "rmw/get_service_names_and_types.h"
#include "rmw/get_topic_names_and_types.h"
#include "rmw/graph/names_and_types.hpp"

using manycore::EndpointInfo;

rmw_ret_t rmw_get_topic_names_and_types(
  const rmw_node_t * node, rcutils_allocator_t * allocator, bool no_demangle,
  rmw_names_and_types_t * topic_names_and_types) {
  // Invariants
  MANYCORE_CHECK_HANDLE(node);
  MANYCORE_CHECK_ALLOCATOR(allocator);
  MANYCORE_CHECK_ZERO_NAMES_AND_TYPES(topic_names_and_types);

  // Implementation
  return rmw_manycore::guarded([&] {
    const auto found = rmw_manycore::names_and_types(
      rmw_manycore::Node::of(node).process().graph().endpoints(),
      [&](const EndpointInfo & endpoint) { return rmw_manycore::is_shown(endpoint, no_demangle); });
    rmw_manycore::write(found, *allocator, *topic_names_and_types);
    return RMW_RET_OK;
  });
}

rmw_ret_t rmw_get_service_names_and_types(
  const rmw_node_t * node, rcutils_allocator_t * allocator,
  rmw_names_and_types_t * service_names_and_types) {
  // Invariants
  MANYCORE_CHECK_HANDLE(node);
  MANYCORE_CHECK_ALLOCATOR(allocator);
  MANYCORE_CHECK_ZERO_NAMES_AND_TYPES(service_names_and_types);

  // Implementation
  return rmw_manycore::guarded([&] {
    const auto found = rmw_manycore::names_and_types(
      rmw_manycore::Node::of(node).process().graph().endpoints(),
      [](const EndpointInfo & endpoint) { return endpoint.role != manycore::EndpointRole::topic; });
    rmw_manycore::write(found, *allocator, *service_names_and_types);
    return RMW_RET_OK;
  });
}
