// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/matching/undelivered.hpp"

#include <algorithm>
#include <tuple>
#include <vector>

#include "transport/queue/source_table.hpp"
#include "transport/registry/endpoint_blocks.hpp"
#include "transport/topic_dsm/last_published.hpp"

namespace manycore::closing {
namespace {

/// Calls `visit(RecordDescriptor &, number)` for each record above `taken`, until it returns true.
template<typename Visit>
void visit_records_above(
  uint64_t taken, const Cluster & cluster, TopicDsmHeader & dsm, Visit visit) {
  const uint64_t last = dsm.last.load(std::memory_order_acquire);
  for (GenerationEntry & generation : dsm.generations) {
    const uint32_t count = generation.descriptor_count.load();
    auto * const descriptors = cluster.find<RecordDescriptor>(
      generation.offset.load(), uint64_t{count} * sizeof(RecordDescriptor));
    if (taken >= last || generation.first.load() == 0 || descriptors == nullptr) {
      continue;
    }
    for (uint32_t i = 0; i < count; ++i) {
      const uint64_t number = descriptors[i].number.load(std::memory_order_acquire);
      if (number > taken && number <= last && visit(descriptors[i], number)) {
        return;
      }
    }
  }
}

struct Waiting {
  uint64_t number;
  int64_t source_timestamp_ns;
  uint32_t source;
};

bool is_newer(const Waiting & a, const Waiting & b) {
  return std::tie(a.source_timestamp_ns, a.source, a.number) >
         std::tie(b.source_timestamp_ns, b.source, b.number);
}

/// In the order of Source::list_waiting(): no timestamp before an earlier record's.
void list_waiting(
  const Cluster & cluster, TopicDsmHeader & dsm, const SourceEntry & source, uint32_t index,
  std::vector<Waiting> & out) {
  const auto begin = static_cast<ptrdiff_t>(out.size());
  visit_records_above(
    source.taken.load(std::memory_order_acquire), cluster, dsm,
    [&](RecordDescriptor & record, uint64_t number) {
      const int64_t timestamp_ns = record.source_timestamp_ns.load(std::memory_order_acquire);
      if (record.number.load(std::memory_order_relaxed) == number) {  // its publisher may live
        out.push_back({number, timestamp_ns, index});
      }
      return false;
    });
  std::sort(out.begin() + begin, out.end(), [](const Waiting & a, const Waiting & b) {
    return a.number < b.number;
  });
  int64_t latest_ns = INT64_MIN;
  for (auto i = static_cast<size_t>(begin); i < out.size(); ++i) {
    latest_ns = std::max(latest_ns, out[i].source_timestamp_ns);
    out[i].source_timestamp_ns = latest_ns;
  }
}

}  // namespace

bool has_undelivered(const OrphanReader & reader) {
  const bool of_replies = static_cast<EndpointRole>(reader.dsm.role) == EndpointRole::reply;
  const uint32_t incarnation = reader.source.incarnation.load(std::memory_order_relaxed);
  bool found = false;
  visit_records_above(
    reader.source.taken.load(std::memory_order_acquire), reader.cluster, reader.dsm,
    [&](RecordDescriptor & record, uint64_t number) {
      found = !of_replies || (record.correlation.client == reader.endpoint.gid &&
                              !Displaced::covers(reader.source.displaced, incarnation, number));
      return found;
    });
  return found;
}

std::set<uint32_t> WantedSources::newest_of(
  SubscriptionHeader & subscription, uint32_t subscription_cluster) {
  std::vector<Waiting> waiting;
  visit_source_table(
    registry_.clusters().at(subscription_cluster), subscription,
    [&](SourceEntry & source, uint32_t index) {
      TopicDsmHeader * const dsm =
        source.state.load() == SourceState::active ? topic_dsm_of(registry_, source) : nullptr;
      if (dsm != nullptr) {
        const SegmentRef ref{source.topic_dsm.load()};
        list_waiting(registry_.clusters().at(ref.cluster()), *dsm, source, index, waiting);
      }
      return false;
    });
  if (waiting.size() > subscription.depth) {
    const auto end = waiting.begin() + static_cast<ptrdiff_t>(subscription.depth);
    std::nth_element(waiting.begin(), end, waiting.end(), is_newer);
    waiting.erase(end, waiting.end());
  }
  std::set<uint32_t> sources;
  for (const Waiting & record : waiting) {
    sources.insert(record.source);
  }
  return sources;
}

bool WantedSources::contain(const OrphanReader & reader) {
  const bool cut_by_depth = reader.subscription.keep_all == 0 &&
                            static_cast<EndpointRole>(reader.dsm.role) != EndpointRole::reply;
  if (!cut_by_depth || !has_undelivered(reader)) {
    return has_undelivered(reader);
  }
  auto known = by_subscription_.find(reader.endpoint_slot);
  if (known == by_subscription_.end()) {
    known =
      by_subscription_
        .emplace(reader.endpoint_slot, newest_of(reader.subscription, reader.endpoint.cluster))
        .first;
  }
  return known->second.count(reader.source_index) != 0;
}

/// The subscription counts its own replies as it misses them.
void count_undelivered(Registry & registry, const OrphanReader & reader) {
  const LastPublished published = last_published(reader.dsm);
  const uint64_t accounted = reader.source.accounted.load(std::memory_order_acquire);
  const bool of_replies = static_cast<EndpointRole>(reader.dsm.role) == EndpointRole::reply;
  if (of_replies || !published.exact || published.sequence <= accounted) {
    return;
  }
  registry.endpoints()[reader.endpoint_slot].counters.lost.fetch_add(
    published.sequence - accounted, std::memory_order_relaxed);
  reader.source.accounted.store(published.sequence, std::memory_order_release);
  notify_event_watchers(registry, reader.endpoint.process);
}

}  // namespace manycore::closing
