// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/matching/freeing.hpp"

#include <algorithm>
#include <optional>

#include "transport/matching/orphans.hpp"
#include "transport/queue/source_table.hpp"
#include "transport/registry/endpoint_blocks.hpp"
#include "transport/topic_dsm/generation.hpp"
#include "transport/topic_dsm/reader_table.hpp"
#include "transport/transfer/transfer.hpp"

namespace manycore::freeing {
namespace {

/// The phases of a receive thread's process: its own, and those of its movers.
bool is_any_odd(const ClusterHeader & header) noexcept {
  bool is_odd = header.phase.load(std::memory_order_seq_cst) % 2 != 0;
  for (const std::atomic<uint64_t> & phase : header.mover_phases) {
    is_odd = is_odd || phase.load(std::memory_order_seq_cst) % 2 != 0;
  }
  return is_odd;
}

/// True if no receive thread still follows references that it loaded before this call. A dead
/// receive thread follows none: if it was killed in its phase, a successor exists only if the
/// cluster has a process. Throws ClusterUnmappable if the phase of a live receive thread cannot be
/// read.
bool receive_threads_are_out(Registry & registry) {
  const uint64_t present = registry.header().clusters_present.load();
  for (uint32_t id = 1; id <= max_clusters; ++id) {
    if ((present >> (id - 1) & 1) == 0) {
      continue;
    }
    const Cluster * const cluster = registry.clusters().find(id);
    const bool may_be_in_phase = cluster == nullptr || is_any_odd(cluster->header());
    if (may_be_in_phase && registry.lifelines().is_held(receive_thread_line + id)) {
      registry.map_cluster(id);
      return false;
    }
  }
  return true;
}

/// Revokes the source of a reader that has taken all of the topic DSM that it can.
Progress revoke(
  Registry & registry, const orphans::Untaken & untaken, const orphans::Reader & reader,
  ReaderEntry & entry) {
  SourceEntry & source = reader.source;
  if (source.state.load() == SourceState::active) {
    if (
      untaken.of(reader) != 0 && transfer::can_arrive(
                                   registry, reader.cluster, reader.dsm, reader.subscription,
                                   reader.endpoint.cluster, source)) {
      return Progress::kept;
    }
    // Dekker with the claim: the reader stores `reading` before it loads the state.
    source.state.store(SourceState::revoked, std::memory_order_seq_cst);
  }
  if (source.reading.load(std::memory_order_seq_cst) != no_record) {
    return Progress::in_use;
  }
  orphans::count_undelivered(registry, reader);
  // Remove the reader before the source entry can be reused: if this process dies in between, the
  // next sweep must not mistake a new match for this one.
  free_reader_entry(reader.cluster, reader.dsm, entry);
  SubscriptionHeader & subscription = reader.subscription;
  subscription.free_source_from = std::min(subscription.free_source_from, reader.source_index);
  source.state.store(SourceState::free, std::memory_order_release);
  subscription.source_generation.fetch_add(1, std::memory_order_release);
  return Progress::none_left;
}

Progress revoke_all(Registry & registry, const Cluster & cluster, TopicDsmHeader & dsm) {
  const orphans::Untaken untaken(cluster, dsm);
  Progress progress = Progress::none_left;
  orphans::for_each_reader(
    registry, cluster, dsm, [&](const orphans::Reader & reader, ReaderEntry & entry) {
      progress = std::max(progress, revoke(registry, untaken, reader, entry));
    });
  return progress;
}

/// Takes up blocks of a table, last block first. False once the hand is full.
template<typename Entry>
bool take_up_table(const Cluster & cluster, const EntryTable<Entry> & table, BlockInHand & hand) {
  while (const auto last = table.last()) {
    hand.take_up(SegmentRef::make(cluster.id(), last->offset), last->bytes);
    table.drop_last();
    if (!hand.is_empty()) {
      return false;
    }
  }
  return true;
}

bool take_up_generations(const Cluster & cluster, TopicDsmHeader & dsm, BlockInHand & hand) {
  for (GenerationEntry & generation : dsm.generations) {
    if (generation.offset.load() != 0) {
      Generation::take_up(cluster, generation, hand);
      if (!hand.is_empty()) {
        return false;
      }
    }
  }
  return true;
}

/// The last block, so no repairer follows the reference in the entry once the block is freed.
Progress take_up_head(EndpointEntry & entry, uint64_t bytes, BlockInHand & hand) {
  hand.take_up(entry.block, bytes);
  entry.block = SegmentRef{};
  return Progress::none_left;
}

/// True if the publisher of `source` holds no references into the subscription: it is not in the
/// phase in which it was when its reader entry was removed. The topic DSM may be freed since, so
/// the publisher's slot is checked first, before the header is read.
bool publisher_is_out(Registry & registry, const SourceEntry & source) {
  const TopicDsmHeader * const dsm = topic_dsm_of(registry, source);
  if (dsm == nullptr || dsm->magic.load() != topic_dsm_magic) {
    return true;
  }
  const uint64_t phase = dsm->phase.load(std::memory_order_seq_cst);
  return phase % 2 == 0 || phase != source.accounted.load();
}

/// Takes up the room for a publisher's records in the subscription's cluster if the subscription
/// was the last to read them there.
void take_up_room_of(
  Registry & registry, const Cluster & cluster, const SourceEntry & source, BlockInHand & hand) {
  TopicDsmHeader * const dsm = topic_dsm_of(registry, source);
  const Cluster * const publisher =
    dsm == nullptr ? nullptr : registry.map_cluster(SegmentRef{source.topic_dsm.load()}.cluster());
  if (publisher != nullptr) {
    transfer::take_up_retired(*publisher, *dsm, cluster, hand);
  }
}

/// A publisher seen outside its phase once stays outside this subscription, which it cannot find
/// any more: its source is freed, so it is not looked at again.
Progress see_publishers_out(
  Registry & registry, Cluster & cluster, SubscriptionHeader & header, BlockInHand & hand) {
  Progress progress = Progress::none_left;
  visit_source_table(cluster, header, [&](SourceEntry & source, uint32_t) {
    if (source.state.load() == SourceState::free) {
      return false;
    }
    if (!publisher_is_out(registry, source)) {
      progress = Progress::in_use;
      return false;
    }
    take_up_room_of(registry, cluster, source, hand);
    source.state.store(SourceState::free);
    if (!hand.is_empty()) {
      progress = Progress::some_left;
    }
    return progress == Progress::some_left;
  });
  return progress;
}

}  // namespace

Progress free_publisher(Registry & registry, uint32_t endpoint, BlockInHand & hand) {
  EndpointEntry & entry = registry.endpoints()[endpoint];
  Cluster * const cluster = registry.map_cluster(entry.block.cluster());
  auto * const dsm = registry.map<TopicDsmHeader>(entry.block);
  if (cluster == nullptr || dsm == nullptr) {
    return Progress::none_left;
  }
  if (entry.slot.state.load() != SlotState::unreachable) {
    if (const Progress progress = revoke_all(registry, *cluster, *dsm);
        progress != Progress::none_left) {
      return progress;
    }
    // Dekker with the receive threads: each stores its phase before it looks at the state.
    entry.slot.state.store(SlotState::freeing, std::memory_order_seq_cst);
    if (!receive_threads_are_out(registry)) {
      return Progress::in_use;
    }
    registry.unlink_endpoint(endpoint, Registry::Chain::orphans);
    entry.slot.state.store(SlotState::unreachable);
  }
  const bool is_head_left = transfer::take_up_all(registry, *cluster, *dsm, hand) &&
                            take_up_generations(*cluster, *dsm, hand) &&
                            take_up_table(*cluster, further_readers(*cluster, *dsm), hand);
  return is_head_left ? take_up_head(entry, header_bytes(*dsm), hand) : Progress::some_left;
}

Progress free_subscription(Registry & registry, uint32_t endpoint, BlockInHand & hand) {
  EndpointEntry & entry = registry.endpoints()[endpoint];
  Cluster * const cluster = registry.map_cluster(entry.block.cluster());
  auto * const header = registry.map<SubscriptionHeader>(entry.block);
  if (cluster == nullptr || header == nullptr) {
    return Progress::none_left;
  }
  if (entry.slot.state.load() != SlotState::unreachable) {
    if (!receive_threads_are_out(registry)) {
      return Progress::in_use;
    }
    if (const Progress progress = see_publishers_out(registry, *cluster, *header, hand);
        progress != Progress::none_left) {
      return progress;
    }
    header->magic.store(0);
    entry.slot.state.store(SlotState::unreachable);
  }
  const bool is_head_left = take_up_table(*cluster, source_table(*cluster, *header), hand);
  return is_head_left ? take_up_head(entry, block_bytes(*header), hand) : Progress::some_left;
}

}  // namespace manycore::freeing
