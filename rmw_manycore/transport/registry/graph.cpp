// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/registry/graph.hpp"

#include <algorithm>

#include "transport/registry/endpoint_blocks.hpp"
#include "transport/registry/snapshot.hpp"
#include "transport/registry/subscription_copy.hpp"

namespace manycore {
namespace {

CounterValues values_of(const EndpointCounters & counters) {
  return {counters.messages.load(), counters.bytes.load(),   counters.lost.load(),
          counters.expired.load(),  counters.refused.load(), counters.overwritten.load(),
          counters.dropped.load(),  counters.held.load()};
}

Activity activity_of(Registry & registry, const EndpointEntry & entry) {
  Activity activity;
  activity.endpoint = endpoint_in(entry.gid);
  activity.counters = values_of(entry.counters);
  const Cluster * const cluster = entry.kind == EndpointKind::subscription
                                    ? registry.clusters().find(entry.block.cluster())
                                    : nullptr;
  SubscriptionCopy copy;
  if (cluster != nullptr && copy.take(*cluster, entry.block.offset())) {
    const SubscriptionHeader & header = *copy;
    activity.counters.lost = lost_so_far(entry, header, header.displaced().hints);
    activity.capacity = header.depth;
    activity.queued = std::min(header.tail.load() - header.head.load(), activity.capacity);
    activity.deadlines_missed = header.deadline.missed(entry.qos.deadline_ns).total;
  }
  return activity;
}

EndpointInfo describe(uint32_t, const EndpointEntry & entry) {
  EndpointInfo info;
  info.kind = entry.kind;
  info.role = entry.role;
  info.topic = text_of(entry.topic);
  info.type = text_of(entry.type);
  info.type_hash.version = entry.type_hash_version;
  std::copy(std::begin(entry.type_hash), std::end(entry.type_hash), info.type_hash.value.begin());
  info.gid = entry.gid;
  info.qos = entry.qos;
  info.node = entry.node;
  info.process = entry.process;
  info.cluster = entry.cluster;
  info.ignore_local = entry.ignore_local != 0;
  info.transfer = entry.transfer;
  return info;
}

std::vector<EndpointInfo> all_endpoints(Registry & registry) {
  return list_live<EndpointInfo>(registry.endpoints(), describe);
}

std::vector<EndpointInfo> chained_endpoints(Registry & registry, const std::string & topic) {
  std::vector<EndpointInfo> all;
  registry.for_each_of_bucket(
    topic.c_str(), [&](uint32_t slot) { append_live(registry.endpoints(), slot, all, describe); });
  return all;
}

std::vector<EndpointInfo> of_topic(const std::string & topic, std::vector<EndpointInfo> all) {
  const auto others = std::remove_if(
    all.begin(), all.end(), [&](const EndpointInfo & info) { return info.topic != topic; });
  all.erase(others, all.end());
  return all;
}

}  // namespace

uint64_t Graph::generation() const noexcept {
  return registry_.header().graph_generation.load(std::memory_order_seq_cst);
}

std::vector<ProcessInfo> Graph::processes() const {
  return read_between_changes(registry_, [&](bool) {
    return list_live<ProcessInfo>(
      registry_.processes(), [](uint32_t slot, const ProcessEntry & entry) -> ProcessInfo {
        return {slot, entry.pid, entry.cluster, entry.core, entry.host_cpu, text_of(entry.label)};
      });
  });
}

std::vector<ClusterInfo> Graph::clusters() const {
  std::vector<ClusterInfo> all;
  const uint64_t present = registry_.header().clusters_present.load();
  for (uint32_t id = 1; id <= max_clusters; ++id) {
    if ((present >> (id - 1) & 1) == 0) {
      continue;
    }
    const Cluster & cluster = registry_.clusters().at(id);
    const ClusterHeader & header = cluster.header();
    all.push_back(
      {id, cluster.size(), cluster.used_bytes(), header.charged_bytes.load(),
       header.receive_thread_pid.load(), header.messages.load(), header.notifications.load()});
  }
  return all;
}

std::vector<NodeInfo> Graph::nodes() const {
  return read_between_changes(registry_, [&](bool) {
    return list_live<NodeInfo>(
      registry_.nodes(), [](uint32_t slot, const NodeEntry & entry) -> NodeInfo {
        return {
          slot, entry.process, text_of(entry.name), text_of(entry.ns), text_of(entry.enclave)};
      });
  });
}

std::vector<EndpointInfo> Graph::endpoints() const {
  return read_between_changes(registry_, [&](bool) { return all_endpoints(registry_); });
}

std::vector<Activity> Graph::activity() const {
  return list_live<Activity>(registry_.endpoints(), [&](uint32_t, const EndpointEntry & entry) {
    return manycore::activity_of(registry_, entry);
  });
}

std::optional<Activity> Graph::activity_of(const Gid & endpoint) const {
  const auto slot = static_cast<uint32_t>(endpoint_in(endpoint));
  std::vector<Activity> found;
  append_live(registry_.endpoints(), slot, found, [&](uint32_t, const EndpointEntry & entry) {
    return manycore::activity_of(registry_, entry);
  });
  const bool is_there = !found.empty() && found[0].endpoint == endpoint_in(endpoint);
  return is_there ? std::optional(found[0]) : std::nullopt;
}

std::vector<Death> Graph::deaths() const {
  return read_between_changes(registry_, [&](bool) {
    const RegistryHeader & header = registry_.header();
    const uint64_t count = header.death_count.load(std::memory_order_acquire);
    std::vector<Death> all;
    for (uint64_t i = count - std::min<uint64_t>(count, kept_deaths); i < count; ++i) {
      all.push_back(header.deaths[i % kept_deaths]);
    }
    return all;
  });
}

std::vector<EndpointInfo> Graph::endpoints_of(const std::string & topic) const {
  return read_between_changes(registry_, [&](bool is_changing) {
    // A change in progress may break chains: scan all endpoints instead.
    return of_topic(
      topic, is_changing ? all_endpoints(registry_) : chained_endpoints(registry_, topic));
  });
}

}  // namespace manycore
