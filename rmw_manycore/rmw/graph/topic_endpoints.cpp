// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/graph/topic_endpoints.hpp"

#include <algorithm>

namespace rmw_manycore {

std::vector<manycore::EndpointInfo> endpoints_of(
  const Node & node, const char * name, manycore::EndpointKind kind, manycore::EndpointRole role) {
  std::vector<manycore::EndpointInfo> found = node.process().graph().endpoints_of(name);
  const auto is_other = [&](const manycore::EndpointInfo & endpoint) {
    return endpoint.kind != kind || endpoint.role != role;
  };
  found.erase(std::remove_if(found.begin(), found.end(), is_other), found.end());
  return found;
}

}  // namespace rmw_manycore
