// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/matching/undelivered.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include "transport/queue/source_table.hpp"
#include "transport/registry/endpoint_blocks.hpp"
#include "transport/topic_dsm/last_published.hpp"
#include "transport/transfer/landing.hpp"

namespace manycore::closing {
namespace {

constexpr uint32_t processes_in_a_step = 16;

/// Calls `visit(RecordDescriptor &)` for each descriptor of open generations from `place` on, until
/// it returns true. False if the turn ended before: `place` is where the next turn goes on. It is a
/// slot of the generations, so what a publisher adds or frees between two turns may be missed, but
/// nothing is visited twice.
template<typename Visit>
bool visit_descriptors(
  const Cluster & cluster, TopicDsmHeader & dsm, DescriptorPlace & place, Turn & turn,
  Visit visit) {
  for (DescriptorPlace at = std::exchange(place, {}); at.generation < max_generations;
       at = {at.generation + 1, 0}) {
    const GenerationEntry & generation = dsm.generations[at.generation];
    const uint32_t count = generation.descriptor_count.load();
    auto * const descriptors = cluster.find<RecordDescriptor>(
      generation.offset.load(), uint64_t{count} * sizeof(RecordDescriptor));
    if (generation.first.load() == 0 || descriptors == nullptr) {
      continue;
    }
    for (; at.descriptor < count; ++at.descriptor) {
      if (at.descriptor % Turn::records_in_a_step == 0) {
        if (turn.is_over()) {
          place = at;
          return false;
        }
        turn.spend(1);
      }
      if (visit(descriptors[at.descriptor])) {
        return true;
      }
    }
  }
  return true;
}

/// As visit_descriptors(): calls `visit(RecordDescriptor &, number)` for each record that `source`
/// has not taken, in no particular order.
template<typename Visit>
bool visit_untaken(
  const Cluster & cluster, TopicDsmHeader & dsm, const SourceEntry & source,
  DescriptorPlace & place, Turn & turn, Visit visit) {
  const uint64_t taken = source.taken.load(std::memory_order_acquire);
  const uint64_t last = dsm.last.load(std::memory_order_acquire);
  if (taken >= last) {
    place = {};
    return true;
  }
  return visit_descriptors(cluster, dsm, place, turn, [&](RecordDescriptor & record) {
    const uint64_t number = record.number.load(std::memory_order_acquire);
    return number > taken && number <= last && visit(record, number);
  });
}

/// As visit_untaken(): calls `visit(number, source_timestamp_ns)` for all of these records.
template<typename Visit>
bool visit_timestamps(
  const Cluster & cluster, TopicDsmHeader & dsm, const SourceEntry & source,
  DescriptorPlace & place, Turn & turn, Visit visit) {
  return visit_untaken(
    cluster, dsm, source, place, turn, [&](const RecordDescriptor & record, uint64_t number) {
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

bool add_undelivered(
  std::optional<Undelivered> & newest, const OrphanReader & reader, DescriptorPlace & place,
  Turn & turn) {
  return visit_timestamps(
    reader.cluster, reader.dsm, reader.source, place, turn,
    [&](uint64_t number, int64_t timestamp_ns) {
      if (!newest) {
        newest = Undelivered{number, timestamp_ns, reader.source_index};
      }
      newest->number = std::max(newest->number, number);
      newest->source_timestamp_ns = std::max(newest->source_timestamp_ns, timestamp_ns);
    });
}

/// Counts from the first record whose own timestamp is newer: later records never count as older
/// (see Undelivered).
std::optional<uint32_t> NewerCount::go_on(
  const Undelivered & record, const Cluster & cluster, TopicDsmHeader & dsm,
  const SourceEntry & source, uint32_t index, Turn & turn) {
  const uint32_t incarnation = source.incarnation.load(std::memory_order_relaxed);
  if (index != source_ || incarnation != incarnation_) {
    *this = NewerCount(index, incarnation);
  }
  if (!knows_first_) {
    const auto find_first = [&](uint64_t number, int64_t timestamp_ns) {
      if (std::tie(timestamp_ns, index) > std::tie(record.source_timestamp_ns, record.source)) {
        first_ = std::min(first_, number);
      }
    };
    knows_first_ = visit_timestamps(cluster, dsm, source, place_, turn, find_first);
  }
  const bool is_complete =
    knows_first_ &&
    (first_ == none || visit_timestamps(
                         cluster, dsm, source, place_, turn,
                         [&](uint64_t number, int64_t) { count_ += number >= first_ ? 1 : 0; }));
  return is_complete ? std::optional(std::exchange(*this, {}).count_) : std::nullopt;
}

std::optional<bool> has_undelivered(
  const OrphanReader & reader, DescriptorPlace & place, Turn & turn) {
  bool found = false;
  const bool is_complete = visit_untaken(
    reader.cluster, reader.dsm, reader.source, place, turn,
    [&](const RecordDescriptor & record, uint64_t number) {
      return found = is_for(reader, record, number);
    });
  return is_complete ? std::optional(found) : std::nullopt;
}

/// Other records than replies are for all readers, so the newest one is not taken if `taken` is
/// less than `last`. A server may have answered any of its clients last, and has one reader for
/// each.
std::optional<bool> may_have_undelivered(const OrphanReader & reader, Turn & turn) {
  if (is_of_replies(reader.dsm)) {
    return has_undelivered(reader, reader.dsm.looked_before, turn);
  }
  return reader.source.taken.load(std::memory_order_acquire) <
         reader.dsm.last.load(std::memory_order_acquire);
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

std::optional<bool> has_arrived(
  Registry & registry, const OrphanReader & reader, DescriptorPlace & place, Turn & turn) {
  const Landing landing = landing_of(registry, reader);
  if (!landing) {
    return false;
  }
  bool found = false;
  const bool is_complete = visit_untaken(
    reader.cluster, reader.dsm, reader.source, place, turn,
    [&](const RecordDescriptor &, uint64_t number) {
      return found = number <= landing.arrived() && landing.has(number);
    });
  return is_complete ? std::optional(found) : std::nullopt;
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
