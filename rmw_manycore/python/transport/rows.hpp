// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "transport/registry/graph.hpp"
#include "transport/registry/registry.hpp"

namespace manycore::python {

/// The shape of a platform, and whether anything of it lives.
struct PlatformRow {
  std::string name;
  Profile profile;
  bool alive;
};

struct ProcessRow : ProcessInfo {
  bool alive;
};

struct ClusterRow : ClusterInfo {
  bool alive;  ///< its receive thread
};

/// An endpoint with the name of its node.
struct EndpointRow : EndpointInfo {
  std::string node_name;
  std::string node_namespace;
};

std::vector<EndpointRow> with_node_names(
  std::vector<EndpointInfo> endpoints, const std::vector<NodeInfo> & nodes);

}  // namespace manycore::python
