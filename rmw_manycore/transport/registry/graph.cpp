// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/registry/graph.hpp"

#include <algorithm>

#include "transport/registry/endpoint_blocks.hpp"
#include "transport/registry/held_memory.hpp"
#include "transport/registry/snapshot.hpp"
#include "transport/registry/subscription_copy.hpp"

namespace manycore {
namespace {

CounterValues values_of(const EndpointCounters & counters) {
  return {counters.messages.load(),    counters.bytes.load(),   counters.lost.load(),
          counters.superseded.load(),  counters.expired.load(), counters.refused.load(),
          counters.overwritten.load(), counters.dropped.load(), counters.in_place.load()};
}

/// An endpoint's activity, without what it holds, and what that is found by.
struct Seen {
  Activity activity;
  EndpointKind kind;
  uint64_t topic_hash;
  uint32_t process;
  std::vector<HeldChunk> held;  ///< of a publisher

  bool holds(const HeldChunk & chunk, const Seen & publisher) const noexcept {
    return kind == EndpointKind::publisher
             ? this == &publisher
             : topic_hash == publisher.topic_hash && chunk.is_held_by(process);
  }
};

Activity activity_of(Registry & registry, uint32_t slot, const EndpointEntry & entry) {
  Activity activity;
  activity.endpoint = trace_endpoint(slot, entry.slot.incarnation);
  activity.counters = values_of(entry.counters);
  const Cluster * const cluster = entry.kind == EndpointKind::subscription
                                    ? registry.clusters().find(entry.block.cluster())
                                    : nullptr;
  SubscriptionCopy copy;
  if (cluster != nullptr && copy.take(*cluster, entry.block.offset())) {
    const SubscriptionHeader & header = *copy;
    const Missed missed = missed_so_far(entry, header, header.displaced().hints);
    activity.counters.lost = missed.lost;
    activity.counters.superseded = missed.superseded;
    activity.capacity = header.depth;
    activity.queued = std::min(header.tail.load() - header.head.load(), activity.capacity);
    activity.deadlines_missed = header.deadline.missed(entry.qos.deadline_ns).total;
  }
  return activity;
}

auto look(Registry & registry, HeldMemory held) {
  return [&registry, held](uint32_t slot, const EndpointEntry & entry) -> Seen {
    return {
      activity_of(registry, slot, entry), entry.kind, entry.topic_hash, entry.process.load(),
      held == HeldMemory::counted ? held_chunks(registry, entry) : std::vector<HeldChunk>()};
  };
}

std::vector<Activity> with_held(const std::vector<Seen> & all) {
  std::vector<const Seen *> publishers;
  for (const Seen & seen : all) {
    if (!seen.held.empty()) {
      publishers.push_back(&seen);
    }
  }
  std::vector<Activity> rows;
  for (const Seen & seen : all) {
    Activity & row = rows.emplace_back(seen.activity);
    for (const Seen * const publisher : publishers) {
      for (const HeldChunk & chunk : publisher->held) {
        row.held_bytes += seen.holds(chunk, *publisher) ? chunk.bytes : 0;
      }
    }
  }
  return rows;
}

EndpointInfo describe(uint32_t slot, const EndpointEntry & entry) {
  EndpointInfo info;
  info.id = trace_endpoint(slot, entry.slot.incarnation);
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
  return with_held(list_live<Seen>(registry_.endpoints(), look(registry_, HeldMemory::counted)));
}

std::vector<Activity> Graph::activity_of(
  const std::vector<EndpointInfo> & endpoints, HeldMemory held) const {
  std::vector<Seen> all;
  for (const EndpointInfo & endpoint : endpoints) {
    const size_t before = all.size();
    append_live(
      registry_.endpoints(), static_cast<uint32_t>(endpoint.id), all, look(registry_, held));
    if (all.size() > before && all.back().activity.endpoint != endpoint.id) {
      all.pop_back();
    }
  }
  return with_held(all);
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
