// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/matching/freeing.hpp"

#include "transport/layout/subscription_layout.hpp"
#include "transport/matching/orphans.hpp"
#include "transport/peers/endpoint_terms.hpp"
#include "transport/registry/topic_rows.hpp"
#include "transport/topic_dsm/chunk_table.hpp"
#include "transport/topic_dsm/generation.hpp"
#include "transport/topic_dsm/seat_table.hpp"
#include "transport/topic_dsm/waiting_publisher.hpp"
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

/// True if no publisher still pushes to the closed subscription: each one that is live was seen
/// outside its phase. A publisher whose row is closed follows nothing.
bool publishers_are_out(Registry & registry, const EndpointEntry & entry, uint32_t slot) {
  const uint64_t subscription = endpoint_word(slot, entry.slot.incarnation.load());
  bool are_out = true;
  for_each_row(
    registry, entry.topic, EndpointKind::publisher, [&](EndpointEntry & other, uint32_t publisher) {
      TopicDsmHeader * const dsm =
        is_live(other) ? registry.map<TopicDsmHeader>(other.block) : nullptr;
      if (dsm == nullptr) {
        return;
      }
      notify_waiting_publisher(*dsm);  // which the closing process may not have done
      const uint64_t phase = dsm->phase.load(std::memory_order_seq_cst);
      const uint64_t word = endpoint_word(publisher, other.slot.incarnation.load());
      are_out = registry.phases_seen().is_out(subscription, word, phase) && are_out;
    });
  return are_out;
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

/// Last block first. False once the hand is full.
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

/// Chunks that a process holds stay: it wakes the reaper when it gives one back, or is reaped.
Progress take_up_chunks(
  Registry & registry, const Cluster & cluster, TopicDsmHeader & dsm, BlockInHand & hand) {
  Progress progress = Progress::none_left;
  chunks_of(cluster, dsm).visit([&](ChunkEntry & entry) {
    const uint64_t offset = entry.offset.load();
    const auto * const head = offset == 0 ? nullptr : cluster.find<ChunkHead>(offset);
    if (head != nullptr && is_held(registry, *head)) {
      progress = Progress::kept;
    } else if (offset != 0) {
      chunk::take_up(cluster, entry, hand);
      progress = hand.is_empty() ? progress : Progress::some_left;
    }
    return progress == Progress::some_left;
  });
  return progress;
}

/// True if a live subscription of that cluster reads the publisher.
bool has_reader(Registry & registry, const EndpointEntry & publisher, uint32_t receiver) {
  const EndpointTerms terms(publisher);
  bool is_any = false;
  for_each_row(
    registry, publisher.topic, EndpointKind::subscription, [&](EndpointEntry & entry, uint32_t) {
      is_any = is_any || (is_live(entry) && entry.cluster == receiver &&
                          fit_of(terms, entry).kind == Fit::Kind::matched);
    });
  return is_any;
}

/// Calls `visit(publisher, its cluster, its topic DSM)` for each publisher of a closed
/// subscription's topic whose records are transferred.
template<typename Visit>
void for_each_transferred(Registry & registry, const EndpointEntry & entry, Visit visit) {
  if (entry.transfer == Transfer::dsm) {
    return;
  }
  for_each_row(
    registry, entry.topic, EndpointKind::publisher, [&](EndpointEntry & publisher, uint32_t) {
      const Cluster * const cluster = registry.map_cluster(publisher.block.cluster());
      auto * const dsm = registry.map<TopicDsmHeader>(publisher.block);
      if (cluster != nullptr && dsm != nullptr && has_memory(publisher.slot.state.load())) {
        visit(publisher, *cluster, *dsm);
      }
    });
}

/// From here on no thread finds the room that publishers have in the cluster of a closed
/// subscription which was the last one there.
void retire_room(Registry & registry, const EndpointEntry & entry) {
  for_each_transferred(
    registry, entry, [&](EndpointEntry & publisher, const Cluster & cluster, TopicDsmHeader & dsm) {
      if (!has_reader(registry, publisher, entry.cluster)) {
        transfer::retire(cluster, dsm, entry.cluster);
      }
    });
}

/// Once movers are out of their phases. False if a publisher is not, or once the hand is full.
bool take_up_retired_room(
  Registry & registry, const Cluster & receiver, const EndpointEntry & entry, BlockInHand & hand) {
  bool is_done = true;
  for_each_transferred(
    registry, entry, [&](EndpointEntry &, const Cluster & cluster, TopicDsmHeader & dsm) {
      is_done =
        is_done && transfer::take_up_retired(cluster, dsm, receiver, hand) && hand.is_empty();
    });
  return is_done;
}

/// The last block, so no repairer follows the reference in the entry once the block is freed.
Progress take_up_head(EndpointEntry & entry, uint64_t bytes, BlockInHand & hand) {
  hand.take_up(entry.block, bytes);
  entry.block = SegmentRef{};
  return Progress::none_left;
}

/// Where the reference to its memory is damaged: the slot may be used again, so it leaves its
/// chain.
Progress give_up(Registry & registry, uint32_t endpoint) {
  registry.unlink_endpoint(endpoint);
  return Progress::none_left;
}

/// Makes the memory of a closed publisher unreachable, once no subscription wants or reads it.
Progress detach_publisher(
  Registry & registry, uint32_t endpoint, const Cluster & cluster, TopicDsmHeader & dsm,
  std::vector<uint32_t> & unwanted) {
  EndpointEntry & entry = registry.endpoints()[endpoint];
  if (entry.slot.state.load() == SlotState::closed) {
    orphans::cut(registry, entry.topic, unwanted);
    if (entry.slot.state.load() == SlotState::closed) {
      return Progress::kept;
    }
  }
  // Dekker with a look: the state was stored seq_cst, and the subscription stores `reading` before
  // it loads the state.
  const bool has_movers = dsm.transfer != static_cast<uint8_t>(Transfer::dsm);
  if (
    orphans::is_being_read(registry, entry, endpoint) ||
    (has_movers && !receive_threads_are_out(registry))) {
    return Progress::in_use;
  }
  orphans::count_undelivered(registry, cluster, dsm);
  registry.unlink_endpoint(endpoint);
  entry.slot.state.store(SlotState::unreachable);
  return Progress::none_left;
}

}  // namespace

Progress free_publisher(
  Registry & registry, uint32_t endpoint, BlockInHand & hand, std::vector<uint32_t> & unwanted) {
  EndpointEntry & entry = registry.endpoints()[endpoint];
  Cluster * const cluster = registry.map_cluster(entry.block.cluster());
  auto * const dsm = registry.map<TopicDsmHeader>(entry.block);
  if (cluster == nullptr || dsm == nullptr) {
    return give_up(registry, endpoint);
  }
  if (entry.slot.state.load() != SlotState::unreachable) {
    if (const Progress progress = detach_publisher(registry, endpoint, *cluster, *dsm, unwanted);
        progress != Progress::none_left) {
      return progress;
    }
  }
  if (
    !transfer::take_up_all(registry, *cluster, *dsm, hand) ||
    !take_up_generations(*cluster, *dsm, hand) ||
    !take_up_table(*cluster, further_seats(*cluster, *dsm), hand)) {
    return Progress::some_left;
  }
  const Progress of_chunks = take_up_chunks(registry, *cluster, *dsm, hand);
  if (of_chunks != Progress::none_left) {
    return of_chunks;
  }
  return take_up_table(*cluster, chunks_of(*cluster, *dsm), hand)
           ? take_up_head(entry, header_bytes(*dsm), hand)
           : Progress::some_left;
}

Progress free_subscription(Registry & registry, uint32_t endpoint, BlockInHand & hand) {
  EndpointEntry & entry = registry.endpoints()[endpoint];
  Cluster * const cluster = registry.map_cluster(entry.block.cluster());
  auto * const header = registry.map<SubscriptionHeader>(entry.block);
  if (cluster == nullptr || header == nullptr) {
    return give_up(registry, endpoint);
  }
  if (entry.slot.state.load() != SlotState::unreachable) {
    retire_room(registry, entry);
    if (!receive_threads_are_out(registry) || !publishers_are_out(registry, entry, endpoint)) {
      return Progress::in_use;
    }
    if (!take_up_retired_room(registry, *cluster, entry, hand)) {
      return hand.is_empty() ? Progress::in_use : Progress::some_left;
    }
    registry.phases_seen().forget(endpoint_word(endpoint, entry.slot.incarnation.load()));
    header->magic.store(0);
    registry.unlink_endpoint(endpoint);
    entry.slot.state.store(SlotState::unreachable);
  }
  return take_up_head(entry, block_bytes(*header), hand);
}

}  // namespace manycore::freeing
