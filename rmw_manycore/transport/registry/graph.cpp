// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/registry/graph.hpp"

#include <algorithm>

#include "transport/registry/endpoint_blocks.hpp"

namespace manycore {
namespace {

CounterValues read_counters(Registry & registry, const EndpointEntry & entry) {
  const EndpointCounters & counters = entry.counters;
  CounterValues values{counters.messages.load(), counters.bytes.load(),
                       counters.lost.load(),     counters.expired.load(),
                       counters.refused.load(),  counters.overwritten.load()};
  if (entry.kind == EndpointKind::subscription) {
    const auto * const header = registry.clusters().find<SubscriptionHeader>(entry.block);
    values.lost = header == nullptr ? values.lost : lost_so_far(entry, *header);
  }
  return values;
}

EndpointInfo describe(Registry & registry, const EndpointEntry & entry) {
  EndpointInfo info;
  info.counters = read_counters(registry, entry);
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
  info.matched = matched_of(entry);
  info.incompatible = incompatible_of(entry);
  return info;
}

}  // namespace

uint64_t Graph::generation() const noexcept {
  return registry_.header().graph_generation.load(std::memory_order_seq_cst);
}

std::vector<ProcessInfo> Graph::processes() const {
  const Registry::Lock lock(registry_);
  std::vector<ProcessInfo> all;
  for (uint32_t slot = 0; slot < registry_.processes().high_water(); ++slot) {
    if (registry_.processes().is_live(slot)) {
      const ProcessEntry & entry = registry_.processes()[slot];
      all.push_back(
        {slot, entry.pid, entry.cluster, entry.core, entry.host_cpu, text_of(entry.label)});
    }
  }
  return all;
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
  const Registry::Lock lock(registry_);
  std::vector<NodeInfo> all;
  for (uint32_t slot = 0; slot < registry_.nodes().high_water(); ++slot) {
    if (registry_.nodes().is_live(slot)) {
      const NodeEntry & entry = registry_.nodes()[slot];
      all.push_back(
        {slot, entry.process, text_of(entry.name), text_of(entry.ns), text_of(entry.enclave)});
    }
  }
  return all;
}

std::vector<EndpointInfo> Graph::endpoints() const {
  const Registry::Lock lock(registry_);
  std::vector<EndpointInfo> all;
  for (uint32_t slot = 0; slot < registry_.endpoints().high_water(); ++slot) {
    if (registry_.endpoints().is_live(slot)) {
      all.push_back(describe(registry_, registry_.endpoints()[slot]));
    }
  }
  return all;
}

std::vector<EndpointInfo> Graph::endpoints_of(const std::string & topic) const {
  const Registry::Lock lock(registry_);
  std::vector<EndpointInfo> all;
  registry_.for_each_of_topic(topic.c_str(), [&](uint32_t, EndpointEntry & entry) {
    all.push_back(describe(registry_, entry));
  });
  return all;
}

}  // namespace manycore
