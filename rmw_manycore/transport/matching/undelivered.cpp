// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/matching/undelivered.hpp"

#include <algorithm>
#include <tuple>

#include "transport/queue/source_table.hpp"
#include "transport/registry/endpoint_blocks.hpp"
#include "transport/topic_dsm/last_published.hpp"
#include "transport/transfer/landing.hpp"

namespace manycore::closing {
namespace {

constexpr uint32_t processes_in_a_step = 16;

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

/// Calls `visit(number, source_timestamp_ns)` for each record that a source has not taken, in no
/// particular order.
template<typename Visit>
void visit_undelivered(
  const Cluster & cluster, TopicDsmHeader & dsm, const SourceEntry & source, Visit visit) {
  visit_records_above(
    source.taken.load(std::memory_order_acquire), cluster, dsm,
    [&](RecordDescriptor & record, uint64_t number) {
      const int64_t timestamp_ns = record.source_timestamp_ns.load(std::memory_order_acquire);
      // Unchanged: a live publisher may recycle it concurrently.
      if (record.number.load(std::memory_order_relaxed) == number) {
        visit(number, timestamp_ns);
      }
      return false;
    });
}

bool has_movers(Registry & registry, uint32_t cluster) {
  const Lifelines & lifelines = registry.lifelines();
  if (lifelines.is_locked(receive_thread_line + cluster)) {
    return true;
  }
  for (uint32_t slot = 0; slot < registry.processes().high_water(); ++slot) {
    if (
      registry.processes().is_live(slot) && registry.processes()[slot].cluster == cluster &&
      lifelines.is_locked(slot)) {
      return true;  // it starts another receive thread
    }
  }
  return false;
}

/// Empty where the reader is in the publisher's own cluster.
Landing landing_of(Registry & registry, const OrphanReader & reader) {
  const Cluster * const to = registry.map_cluster(reader.endpoint.cluster);
  return to == nullptr ? Landing() : Landing::of(reader.cluster, reader.dsm, *to);
}

}  // namespace

std::optional<OrphanReader> orphan_reader(
  Registry & registry, const Cluster & cluster, TopicDsmHeader & dsm, const ReaderEntry & entry) {
  auto * const source = registry.map<SourceEntry>(SegmentRef{entry.source.load()});
  auto * const header = registry.map<SubscriptionHeader>(SegmentRef{entry.subscription.load()});
  const uint32_t slot = entry.endpoint.load();
  if (source == nullptr || header == nullptr || slot >= registry.endpoints().high_water()) {
    return std::nullopt;
  }
  return OrphanReader{
    cluster, dsm, *header, *source, registry.endpoints()[slot], slot, entry.source_index.load()};
}

uint64_t records_to_look_at(TopicDsmHeader & dsm, const SourceEntry & source) {
  if (source.taken.load(std::memory_order_acquire) >= dsm.last.load(std::memory_order_acquire)) {
    return 0;
  }
  uint64_t count = 0;
  for (const GenerationEntry & generation : dsm.generations) {
    count += generation.first.load() == 0 ? 0 : generation.descriptor_count.load();
  }
  return count;
}

std::optional<Undelivered> newest_undelivered(
  const Cluster & cluster, TopicDsmHeader & dsm, const SourceEntry & source, uint32_t index) {
  std::optional<Undelivered> newest;
  visit_undelivered(cluster, dsm, source, [&](uint64_t number, int64_t timestamp_ns) {
    if (!newest) {
      newest = Undelivered{number, timestamp_ns, index};
    }
    newest->number = std::max(newest->number, number);
    newest->source_timestamp_ns = std::max(newest->source_timestamp_ns, timestamp_ns);
  });
  return newest;
}

/// Counts from the first record whose own timestamp is newer: later records never count as older
/// (see Undelivered).
uint32_t count_newer_than(
  const Undelivered & record, const Cluster & cluster, TopicDsmHeader & dsm,
  const SourceEntry & source, uint32_t index) {
  constexpr uint64_t none = UINT64_MAX;
  uint64_t first_newer = none;
  visit_undelivered(cluster, dsm, source, [&](uint64_t number, int64_t timestamp_ns) {
    if (std::tie(timestamp_ns, index) > std::tie(record.source_timestamp_ns, record.source)) {
      first_newer = std::min(first_newer, number);
    }
  });
  uint32_t count = 0;
  if (first_newer != none) {
    visit_undelivered(cluster, dsm, source, [&](uint64_t number, int64_t) {
      count += number >= first_newer ? 1 : 0;
    });
  }
  return count;
}

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

bool is_abandoned(Registry & registry, const OrphanReader & reader, Turn & turn) {
  if (
    static_cast<Transfer>(reader.dsm.transfer) != Transfer::session ||
    !landing_of(registry, reader)) {
    return false;
  }
  turn.spend(registry.processes().high_water() / processes_in_a_step);
  return !has_movers(registry, reader.cluster.id());
}

bool has_arrived(Registry & registry, const OrphanReader & reader) {
  const Landing landing = landing_of(registry, reader);
  bool found = false;
  if (landing) {
    visit_records_above(
      reader.source.taken.load(std::memory_order_acquire), reader.cluster, reader.dsm,
      [&](RecordDescriptor &, uint64_t number) {
        return found = number <= landing.arrived() && landing.has(number);
      });
  }
  return found;
}

/// Replies are excluded: a client counts those itself as it misses them.
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
