// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/graph.hpp"

#include <algorithm>

#include "transport/registry.hpp"

namespace manycore {
namespace {

EndpointInfo describe(const EndpointEntry & entry) {
  EndpointInfo info;
  info.kind = entry.kind;
  info.role = entry.role;
  info.topic = entry.topic;
  info.type = entry.type;
  info.type_hash.version = entry.type_hash_version;
  std::copy(std::begin(entry.type_hash), std::end(entry.type_hash), info.type_hash.value.begin());
  info.gid = entry.gid;
  info.qos = entry.qos;
  info.node = entry.node;
  info.process = entry.process;
  info.cluster = entry.cluster;
  info.matched = {entry.matched_total.load(), entry.matched_current.load()};
  info.incompatible = {
    entry.incompatible_total.load(), static_cast<QosPolicy>(entry.incompatible_policy.load())};
  return info;
}

}  // namespace

uint64_t Graph::generation() const noexcept {
  return registry_.header().graph_generation.load(std::memory_order_seq_cst);
}

std::vector<NodeInfo> Graph::nodes() const {
  const Registry::Lock lock(registry_);
  std::vector<NodeInfo> all;
  for (uint32_t slot = 0; slot < registry_.nodes().high_water(); ++slot) {
    if (registry_.nodes().is_live(slot)) {
      const NodeEntry & entry = registry_.nodes()[slot];
      all.push_back({slot, entry.process, entry.name, entry.ns, entry.enclave});
    }
  }
  return all;
}

std::vector<EndpointInfo> Graph::endpoints() const {
  const Registry::Lock lock(registry_);
  std::vector<EndpointInfo> all;
  for (uint32_t slot = 0; slot < registry_.endpoints().high_water(); ++slot) {
    if (registry_.endpoints().is_live(slot)) {
      all.push_back(describe(registry_.endpoints()[slot]));
    }
  }
  return all;
}

std::vector<EndpointInfo> Graph::endpoints_of(const std::string & topic) const {
  const Registry::Lock lock(registry_);
  std::vector<EndpointInfo> all;
  registry_.for_each_of_topic(topic.c_str(), [&](uint32_t, EndpointEntry & entry) {
    all.push_back(describe(entry));
  });
  return all;
}

}  // namespace manycore
