// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "transport/layout/registry_layout.hpp"

namespace manycore {

class Registry;

struct NodeInfo {
  uint32_t handle = 0;
  uint32_t process = 0;  ///< process slot
  std::string name;
  std::string ns;
  std::string enclave;
};

/// What an endpoint has done so far.
struct CounterValues {
  uint64_t messages = 0;     ///< published or taken
  uint64_t bytes = 0;        ///< of serialized data
  uint64_t lost = 0;         ///< subscription: gone before they were taken
  uint64_t expired = 0;      ///< subscription: older than their lifespan when their turn came
  uint64_t refused = 0;      ///< publisher: did not fit
  uint64_t overwritten = 0;  ///< publisher: recycled while a reader still wanted them
};

struct ProcessInfo {
  uint32_t slot = 0;
  int32_t pid = 0;
  uint32_t cluster = 0;
  int32_t core = -1;      ///< -1 = not placed on a core
  int32_t host_cpu = -1;  ///< -1 = not pinned
  std::string label;
};

struct ClusterInfo {
  uint32_t id = 0;
  uint64_t smem_bytes = 0;
  uint64_t used_bytes = 0;     ///< of smem_bytes
  uint64_t charged_bytes = 0;  ///< of used_bytes: memory of processes outside the segment
  int32_t receive_thread_pid = 0;
  uint64_t messages = 0;       ///< eMCOS messages handled
  uint64_t notifications = 0;  ///< hints pushed by the receive thread
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
  CounterValues counters;
};

/// What changes with every message: the counters of an endpoint, and its queue.
struct Activity {
  uint64_t endpoint = 0;  ///< slot and incarnation, as endpoint_in() its gid
  CounterValues counters;
  uint64_t queued = 0;    ///< subscription: hints in its queue, not what a resync has set aside
  uint64_t capacity = 0;  ///< subscription: hints that its queue can hold
  uint64_t deadlines_missed = 0;  ///< subscription: periods of its deadline without a message
};
static_assert(sizeof(Activity) == 80);

/// Consistent snapshots of who is on the platform, without the registry lock. Any thread; never on
/// the data path.
class Graph {
public:
  explicit Graph(Registry & registry) noexcept : registry_(registry) {}

  /// Changes whenever a node or endpoint comes or goes.
  uint64_t generation() const noexcept;
  std::vector<ProcessInfo> processes() const;
  std::vector<ClusterInfo> clusters() const;
  std::vector<NodeInfo> nodes() const;
  std::vector<EndpointInfo> endpoints() const;
  /// A small part of endpoints(), for those that look often. Each row is whole; they may be of
  /// different moments.
  std::vector<Activity> activity() const;
  /// The deaths that are still known, oldest first.
  std::vector<Death> deaths() const;
  /// Endpoints of one topic or service only (constant-time lookup by name).
  std::vector<EndpointInfo> endpoints_of(const std::string & topic) const;

private:
  Registry & registry_;
};

}  // namespace manycore
