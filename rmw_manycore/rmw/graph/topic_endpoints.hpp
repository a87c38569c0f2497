// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "rmw/context/node.hpp"
#include "transport/registry/graph.hpp"

namespace rmw_manycore {

/// Current endpoints of this name, kind and role.
std::vector<manycore::EndpointInfo> endpoints_of(
  const Node & node, const char * name, manycore::EndpointKind kind, manycore::EndpointRole role);

inline std::vector<manycore::EndpointInfo> publishers_of(const Node & node, const char * topic) {
  return endpoints_of(
    node, topic, manycore::EndpointKind::publisher, manycore::EndpointRole::topic);
}

inline std::vector<manycore::EndpointInfo> subscriptions_of(const Node & node, const char * topic) {
  return endpoints_of(
    node, topic, manycore::EndpointKind::subscription, manycore::EndpointRole::topic);
}

}  // namespace rmw_manycore
