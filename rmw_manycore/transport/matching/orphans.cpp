// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/matching/orphans.hpp"

#include <algorithm>
#include <cstring>
#include <tuple>
#include <unordered_map>

#include "transport/queue/displaced.hpp"
#include "transport/registry/endpoint_blocks.hpp"
#include "transport/topic_dsm/last_published.hpp"
#include "transport/topic_dsm/reader_table.hpp"

namespace manycore::orphans {
namespace {

bool is_of_replies(const TopicDsmHeader & dsm) {
  return static_cast<EndpointRole>(dsm.role) == EndpointRole::reply;
}

/// Calls `visit(RecordDescriptor &, number)` for each record of a topic DSM.
template<typename Visit>
void visit_records(const Cluster & cluster, TopicDsmHeader & dsm, Visit visit) {
  for (const GenerationEntry & generation : dsm.generations) {
    const uint32_t count = generation.descriptor_count.load();
    auto * const descriptors = cluster.find<RecordDescriptor>(
      generation.offset.load(), uint64_t{count} * sizeof(RecordDescriptor));
    if (generation.first.load() == 0 || descriptors == nullptr) {
      continue;
    }
    for (uint32_t i = 0; i < count; ++i) {
      const uint64_t number = descriptors[i].number.load(std::memory_order_acquire);
      if (number != no_record) {
        visit(descriptors[i], number);
      }
    }
  }
}

/// Cost of a topic DSM in the history of a subscription.
uint64_t cost(const Reader & reader, uint64_t untaken) {
  return reader.subscription.keep_all != 0 ? 1 : untaken;
}

}  // namespace

std::optional<Reader> reader_of(
  Registry & registry, const Cluster & cluster, TopicDsmHeader & dsm, const ReaderEntry & entry) {
  auto * const source = registry.map<SourceEntry>(SegmentRef{entry.source.load()});
  auto * const header = registry.map<SubscriptionHeader>(SegmentRef{entry.subscription.load()});
  const uint32_t slot = entry.endpoint.load();
  if (source == nullptr || header == nullptr || slot >= registry.endpoints().high_water()) {
    return std::nullopt;
  }
  return Reader{
    cluster, dsm, *header, *source, registry.endpoints()[slot], slot, entry.source_index.load()};
}

void for_each_reader(
  Registry & registry, const Cluster & cluster, TopicDsmHeader & dsm,
  const std::function<void(const Reader &, ReaderEntry &)> & visit) {
  manycore::for_each_reader(cluster, dsm, [&](ReaderEntry & entry) {
    if (const std::optional<Reader> reader = reader_of(registry, cluster, dsm, entry)) {
      visit(*reader, entry);
    }
  });
}

Untaken::Untaken(const Cluster & cluster, TopicDsmHeader & dsm) : dsm_(dsm) {
  if (!is_of_replies(dsm)) {
    return;
  }
  visit_records(cluster, dsm, [&](const RecordDescriptor & record, uint64_t number) {
    replies_.push_back({record.correlation.client, number});
  });
  std::sort(replies_.begin(), replies_.end(), [](const Reply & a, const Reply & b) {
    return std::tie(a.client, a.number) < std::tie(b.client, b.number);
  });
}

uint64_t Untaken::of(const Reader & reader) const noexcept {
  if (is_of_replies(dsm_)) {
    return has_reply(reader) ? 1 : 0;
  }
  if (
    reader.source.taken.load(std::memory_order_acquire) >=
    dsm_.last.load(std::memory_order_acquire)) {
    return 0;
  }
  const uint64_t published = last_published(dsm_).sequence;
  const uint64_t accounted = reader.source.accounted.load(std::memory_order_acquire);
  return std::max<uint64_t>(published - std::min(published, accounted), 1);
}

/// The newest one tells: hints are displaced in order.
bool Untaken::has_reply(const Reader & reader) const noexcept {
  const Gid & client = reader.endpoint.gid;
  const auto after = std::upper_bound(
    replies_.begin(), replies_.end(), client,
    [](const Gid & wanted, const Reply & reply) { return wanted < reply.client; });
  if (after == replies_.begin() || (after - 1)->client != client) {
    return false;
  }
  const uint64_t newest = (after - 1)->number;
  const uint32_t incarnation = reader.source.incarnation.load(std::memory_order_relaxed);
  return newest > reader.source.taken.load(std::memory_order_acquire) &&
         !Displaced::covers(reader.source.displaced, incarnation, newest);
}

void cut(Registry & registry, const char * topic, std::vector<uint32_t> & unread) {
  std::unordered_map<uint32_t, uint64_t> kept;  // by slot of the subscription
  registry.for_each_of_bucket(topic, Registry::Chain::orphans, [&](uint32_t slot) {
    const EndpointEntry & entry = registry.endpoints()[slot];
    Cluster * const cluster = registry.map_cluster(entry.block.cluster());
    auto * const dsm = registry.map<TopicDsmHeader>(entry.block);
    if (
      cluster == nullptr || dsm == nullptr || !has_memory(entry.slot.state.load()) ||
      std::strncmp(entry.topic, topic, name_bytes) != 0) {
      return;
    }
    const Untaken untaken(*cluster, *dsm);
    bool is_cut = false;
    for_each_reader(registry, *cluster, *dsm, [&](const Reader & reader, ReaderEntry &) {
      const uint64_t count = untaken.of(reader);
      uint64_t & of_newer = kept[reader.endpoint_slot];
      if (count != 0 && of_newer >= reader.subscription.depth) {
        reader.source.state.store(SourceState::revoked, std::memory_order_seq_cst);
        is_cut = true;
      }
      of_newer += cost(reader, count);
    });
    if (is_cut) {
      unread.push_back(slot);
    }
  });
}

/// Replies are excluded: a client counts those itself as it misses them.
void count_undelivered(Registry & registry, const Reader & reader) {
  const LastPublished published = last_published(reader.dsm);
  const uint64_t accounted = reader.source.accounted.load(std::memory_order_acquire);
  if (is_of_replies(reader.dsm) || !published.exact || published.sequence <= accounted) {
    return;
  }
  registry.endpoints()[reader.endpoint_slot].counters.lost.fetch_add(
    published.sequence - accounted, std::memory_order_relaxed);
  reader.source.accounted.store(published.sequence, std::memory_order_release);
  notify_event_watchers(registry, reader.endpoint.process);
}

}  // namespace manycore::orphans
