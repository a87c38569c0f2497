// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "transport/layout/registry_layout.hpp"

namespace manycore {

class Registry;

/// A node in a snapshot of the graph.
struct NodeInfo {
  uint32_t handle = 0;
  uint32_t process = 0;  ///< process slot
  std::string name;
  std::string ns;
  std::string enclave;
};

/// Counters of an endpoint since its creation.
struct CounterValues {
  uint64_t messages = 0;     ///< published or taken
  uint64_t bytes = 0;        ///< size of serialized data
  uint64_t lost = 0;         ///< subscription: messages gone before they were taken
  uint64_t superseded = 0;   ///< subscription: messages in whose place a newer one was found
  uint64_t expired = 0;      ///< subscription: messages past their lifespan when about to be taken
  uint64_t refused = 0;      ///< publisher: messages that did not fit
  uint64_t overwritten = 0;  ///< publisher: records recycled while a reader still wanted them
  uint64_t dropped = 0;      ///< publisher: records that did not reach a cluster
  uint64_t in_place = 0;     ///< messages written or read without a copy
};

/// A process in a snapshot of the graph.
struct ProcessInfo {
  uint32_t slot = 0;
  int32_t pid = 0;
  uint32_t cluster = 0;
  int32_t core = -1;      ///< -1 = not placed on a core
  int32_t host_cpu = -1;  ///< -1 = not pinned
  std::string label;
};

/// A cluster in a snapshot of the graph.
struct ClusterInfo {
  uint32_t id = 0;
  uint64_t smem_bytes = 0;
  uint64_t used_bytes = 0;     ///< part of smem_bytes, allocated or charged
  uint64_t charged_bytes = 0;  ///< part of used_bytes: memory of processes outside the segment
  int32_t receive_thread_pid = 0;
  uint64_t messages = 0;       ///< eMCOS messages handled by the receive thread
  uint64_t notifications = 0;  ///< hints pushed by the receive thread
};

/// An endpoint in a snapshot of the graph.
struct EndpointInfo {
  uint64_t id = 0;  ///< slot and incarnation, as by trace_endpoint()
  EndpointKind kind = EndpointKind::publisher;
  EndpointRole role = EndpointRole::topic;
  std::string topic;
  std::string type;
  TypeHash type_hash;
  Gid gid{};
  Qos qos;
  uint32_t node = 0;     ///< node handle
  uint32_t process = 0;  ///< process slot
  uint32_t cluster = 0;
  bool ignore_local = false;
  Transfer transfer = Transfer::dsm;  ///< of the topic
};

/// State of an endpoint that changes with each message: counters and queue.
struct Activity {
  uint64_t endpoint = 0;  ///< its id
  CounterValues counters;
  uint64_t queued = 0;    ///< subscription: hints in its queue, without the backlog of a resync
  uint64_t capacity = 0;  ///< subscription: queue capacity in hints
  uint64_t deadlines_missed = 0;  ///< subscription: missed periods of the requested deadline
  /// SMEM of large records that readers hold. Publisher: of its own. Subscription: of its topic, by
  /// its process.
  uint64_t held_bytes = 0;
};
static_assert(sizeof(Activity) == 112);

/// Whether to look for what readers hold, at a system call for each publisher and chunk.
enum class HeldMemory { counted, skipped };

/// Consistent snapshots of the platform's processes, clusters, nodes and endpoints. Takes no
/// registry lock. Thread-safe; not for use on the data path.
class Graph {
public:
  explicit Graph(Registry & registry) noexcept : registry_(registry) {}

  /// Incremented whenever a node or endpoint is added or removed.
  uint64_t generation() const noexcept;
  std::vector<ProcessInfo> processes() const;
  std::vector<ClusterInfo> clusters() const;
  std::vector<NodeInfo> nodes() const;
  std::vector<EndpointInfo> endpoints() const;
  /// Activity of all endpoints. Each row is consistent in itself; rows may be of different moments.
  std::vector<Activity> activity() const;
  /// Of these endpoints only, as far as they still exist; what subscriptions hold, of publishers
  /// among them, or 0.
  std::vector<Activity> activity_of(
    const std::vector<EndpointInfo> & endpoints, HeldMemory held) const;
  /// Deaths still recorded, oldest first.
  std::vector<Death> deaths() const;
  /// Endpoints of one topic or service; a constant-time lookup by name.
  std::vector<EndpointInfo> endpoints_of(const std::string & topic) const;

private:
  Registry & registry_;
};

}  // namespace manycore
