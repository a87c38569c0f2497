// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "transport/registry/graph.hpp"
#include "transport/registry/registry.hpp"

namespace manycore::python {

/// Shape of a platform, and whether any of its processes lives.
struct PlatformRow {
  std::string name;
  Profile profile;
  bool alive;
};

/// A process, and whether it lives.
struct ProcessRow : ProcessInfo {
  bool alive;
};

/// A cluster, and whether its receive thread lives.
struct ClusterRow : ClusterInfo {
  bool alive;  ///< its receive thread lives
};

/// An endpoint with its counters and the name of its node.
struct EndpointRow : EndpointInfo {
  CounterValues counters;
  uint64_t held_bytes;  ///< see Activity
  std::string node_name;
  std::string node_namespace;
  uint64_t matched = 0;  ///< endpoints of the snapshot with which it is matched
};

/// Adds to each endpoint its counters, and name and namespace of its node; empty if the node is
/// gone. Leaves out endpoints that have left meanwhile.
std::vector<EndpointRow> rows_of(
  const Graph & graph, std::vector<EndpointInfo> endpoints, HeldMemory held);

}  // namespace manycore::python
