// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "transport/endpoint.hpp"

namespace manycore {

class Registry;

struct NodeInfo {
  uint32_t handle = 0;
  uint32_t process = 0;  ///< process slot
  std::string name;
  std::string ns;
  std::string enclave;
};

struct EndpointInfo {
  EndpointKind kind = EndpointKind::publisher;
  EndpointRole role = EndpointRole::topic;
  std::string topic;
  std::string type;
  TypeHash type_hash;
  Gid gid{};
  Qos qos;
  uint32_t node = 0;     ///< handle of its node
  uint32_t process = 0;  ///< process slot
  uint32_t cluster = 0;
  MatchedCount matched;
  IncompatibleCount incompatible;
};

/// Consistent snapshots of who is on the platform. Any thread; never on the data path.
class Graph {
public:
  explicit Graph(Registry & registry) noexcept : registry_(registry) {}

  /// Changes whenever a node or endpoint comes or goes.
  uint64_t generation() const noexcept;
  std::vector<NodeInfo> nodes() const;
  std::vector<EndpointInfo> endpoints() const;
  /// Endpoints of one topic or service only (constant-time lookup by name).
  std::vector<EndpointInfo> endpoints_of(const std::string & topic) const;

private:
  Registry & registry_;
};

}  // namespace manycore
