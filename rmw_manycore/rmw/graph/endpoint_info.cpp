// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/graph/endpoint_info.hpp"

#include <algorithm>

namespace rmw_manycore {

rosidl_type_hash_t to_rosidl(const manycore::TypeHash & hash) {
  rosidl_type_hash_t result = rosidl_get_zero_initialized_type_hash();
  result.version = hash.version;
  std::copy(hash.value.begin(), hash.value.end(), result.value);
  return result;
}

manycore::NodeInfo find_node(const std::vector<manycore::NodeInfo> & nodes, uint32_t handle) {
  const auto found = std::find_if(nodes.begin(), nodes.end(), [&](const manycore::NodeInfo & node) {
    return node.handle == handle;
  });
  if (found != nodes.end()) {
    return *found;
  }
  manycore::NodeInfo unknown;
  unknown.name = "_NODE_NAME_UNKNOWN_";
  unknown.ns = "_NODE_NAMESPACE_UNKNOWN_";
  return unknown;
}

}  // namespace rmw_manycore
