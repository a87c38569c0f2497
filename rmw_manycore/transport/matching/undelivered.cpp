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

/// Calls `visit(RecordDescriptor &, index)` for each descriptor of open generations from index
/// `from` on, until it returns true. Indices continue from one generation to the next.
template<typename Visit>
void visit_descriptors(const Cluster & cluster, TopicDsmHeader & dsm, uint32_t from, Visit visit) {
  uint32_t begin = 0;
  for (GenerationEntry & generation : dsm.generations) {
    const uint32_t count = generation.descriptor_count.load();
    auto * const descriptors = cluster.find<RecordDescriptor>(
      generation.offset.load(), uint64_t{count} * sizeof(RecordDescriptor));
    if (generation.first.load() == 0 || descriptors == nullptr) {
      continue;
    }
    for (uint32_t i = from > begin ? from - begin : 0; i < count; ++i) {
      if (visit(descriptors[i], begin + i)) {
        return;
      }
    }
    begin += count;
  }
}

/// Calls `visit(RecordDescriptor &, number)` for each record above `taken`, until it returns true.
template<typename Visit>
void visit_records_above(
  uint64_t taken, const Cluster & cluster, TopicDsmHeader & dsm, Visit visit) {
  const uint64_t last = dsm.last.load(std::memory_order_acquire);
  if (taken >= last) {
    return;
  }
  visit_descriptors(cluster, dsm, 0, [&](RecordDescriptor & record, uint32_t) {
    const uint64_t number = record.number.load(std::memory_order_acquire);
    return number > taken && number <= last && visit(record, number);
  });
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

bool is_of_replies(const TopicDsmHeader & dsm) {
  return static_cast<EndpointRole>(dsm.role) == EndpointRole::reply;
}

/// Replies are for the client that asked, unless their hint was displaced; other records are for
/// all.
bool is_for(const OrphanReader & reader, const RecordDescriptor & record, uint64_t number) {
  const uint32_t incarnation = reader.source.incarnation.load(std::memory_order_relaxed);
  return !is_of_replies(reader.dsm) ||
         (record.correlation.client == reader.endpoint.gid &&
          !Displaced::covers(reader.source.displaced, incarnation, number));
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
  bool found = false;
  visit_records_above(
    reader.source.taken.load(std::memory_order_acquire), reader.cluster, reader.dsm,
    [&](const RecordDescriptor & record, uint64_t number) {
      return found = is_for(reader, record, number);
    });
  return found;
}

/// Other records than replies are for all readers, so the newest one is not taken if `taken` is
/// less than `last`. A server may have answered any of its clients last, and has one reader for
/// each: the search for replies goes on in the next turn.
std::optional<bool> may_have_undelivered(const OrphanReader & reader, Turn & turn) {
  const uint64_t taken = reader.source.taken.load(std::memory_order_acquire);
  const bool is_behind = taken < reader.dsm.last.load(std::memory_order_acquire);
  if (!is_behind || !is_of_replies(reader.dsm)) {
    return is_behind;
  }
  std::optional<bool> found = false;
  const auto visit = [&](const RecordDescriptor & record, uint32_t index) {
    if (index % Turn::records_in_a_step == 0) {
      if (turn.is_over()) {
        reader.dsm.looked_before = index;
        found.reset();
        return true;
      }
      turn.spend(1);
    }
    const uint64_t number = record.number.load(std::memory_order_acquire);
    found = number > taken && is_for(reader, record, number);
    return *found;
  };
  visit_descriptors(reader.cluster, reader.dsm, reader.dsm.looked_before, visit);
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
  if (is_of_replies(reader.dsm) || !published.exact || published.sequence <= accounted) {
    return;
  }
  registry.endpoints()[reader.endpoint_slot].counters.lost.fetch_add(
    published.sequence - accounted, std::memory_order_relaxed);
  reader.source.accounted.store(published.sequence, std::memory_order_release);
  notify_event_watchers(registry, reader.endpoint.process);
}

}  // namespace manycore::closing
