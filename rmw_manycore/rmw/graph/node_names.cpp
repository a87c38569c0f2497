// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/common/checks.hpp"
#include "rmw/common/error.hpp"
#include "rmw/common/string_array.hpp"
#include "rmw/context/node.hpp"
#include "rmw/rmw.h"
#include "rmw/sanity_checks.h"

namespace rmw_manycore {
namespace {

using manycore::NodeInfo;

/// Writes one attribute of all nodes.
void fill(
  StringArray & array, const std::vector<NodeInfo> & nodes, std::string NodeInfo::*attribute) {
  for (size_t i = 0; i < nodes.size(); ++i) {
    array.set(i, (nodes[i].*attribute).c_str());
  }
}

/// `enclaves` may be null.
void write_nodes(
  const std::vector<NodeInfo> & nodes, rcutils_string_array_t & names,
  rcutils_string_array_t & namespaces, rcutils_string_array_t * enclaves) {
  const rcutils_allocator_t allocator = rcutils_get_default_allocator();
  StringArray name_array(nodes.size(), allocator);
  StringArray namespace_array(nodes.size(), allocator);
  StringArray enclave_array(nodes.size(), allocator);
  fill(name_array, nodes, &NodeInfo::name);
  fill(namespace_array, nodes, &NodeInfo::ns);
  fill(enclave_array, nodes, &NodeInfo::enclave);
  names = name_array.release();
  namespaces = namespace_array.release();
  if (enclaves != nullptr) {
    *enclaves = enclave_array.release();
  }
}

}  // namespace
}  // namespace rmw_manycore

rmw_ret_t rmw_get_node_names(
  const rmw_node_t * node, rcutils_string_array_t * node_names,
  rcutils_string_array_t * node_namespaces) {
  // Invariants
  MANYCORE_CHECK_HANDLE(node);
  MANYCORE_CHECK_ZERO_STRING_ARRAY(node_names);
  MANYCORE_CHECK_ZERO_STRING_ARRAY(node_namespaces);

  // Implementation
  return rmw_manycore::guarded([&] {
    rmw_manycore::write_nodes(
      rmw_manycore::Node::of(node).process().graph().nodes(), *node_names, *node_namespaces,
      nullptr);
    return RMW_RET_OK;
  });
}

rmw_ret_t rmw_get_node_names_with_enclaves(
  const rmw_node_t * node, rcutils_string_array_t * node_names,
  rcutils_string_array_t * node_namespaces, rcutils_string_array_t * enclaves) {
  // Invariants
  MANYCORE_CHECK_HANDLE(node);
  MANYCORE_CHECK_ZERO_STRING_ARRAY(node_names);
  MANYCORE_CHECK_ZERO_STRING_ARRAY(node_namespaces);
  MANYCORE_CHECK_ZERO_STRING_ARRAY(enclaves);

  // Implementation
  return rmw_manycore::guarded([&] {
    rmw_manycore::write_nodes(
      rmw_manycore::Node::of(node).process().graph().nodes(), *node_names, *node_namespaces,
      enclaves);
    return RMW_RET_OK;
  });
}
