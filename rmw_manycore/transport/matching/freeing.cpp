// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/matching/freeing.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "transport/matching/detaching.hpp"
#include "transport/matching/match_in_hand.hpp"
#include "transport/matching/spare_blocks.hpp"
#include "transport/queue/source_table.hpp"
#include "transport/registry/endpoint_blocks.hpp"
#include "transport/topic_dsm/generation.hpp"
#include "transport/topic_dsm/reader_table.hpp"
#include "transport/transfer/landing.hpp"
#include "transport/transfer/landings.hpp"

namespace manycore::sweeping {
namespace {

using closing::OrphanReader;

constexpr uint64_t steps_of_a_reader = 8;
constexpr uint64_t steps_of_a_source = 2;
constexpr uint32_t free_readers_in_a_step = 16;

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

/// Revokes the source of a reader that has taken all of the topic DSM that it can, or that wants
/// newer messages of other publishers instead.
Progress revoke(
  Registry & registry, WantedSources & wanted, uint32_t publisher, const OrphanReader & reader,
  ReaderEntry & entry, Turn & turn) {
  SourceEntry & source = reader.source;
  match_in_hand::note(registry.header(), publisher, reader.endpoint_slot);
  if (source.state.load() == SourceState::active) {
    const std::optional<bool> is_wanted = wanted.contain(reader, turn);
    if (!is_wanted) {
      return Progress::turn_over;
    }
    if (*is_wanted) {
      return Progress::kept;
    }
    // Dekker with the claim: the reader stores `reading` before it loads the state.
    source.state.store(SourceState::revoked, std::memory_order_seq_cst);
  }
  if (source.reading.load(std::memory_order_seq_cst) != no_record) {
    return Progress::in_use;
  }
  closing::count_undelivered(registry, reader);
  // Remove the reader before the source entry can be reused: if this process dies in between, the
  // next sweep must not mistake a new match for this one.
  remove_reader(reader.cluster, reader.dsm, entry);
  SubscriptionHeader & subscription = reader.subscription;
  subscription.free_source_from = std::min(subscription.free_source_from, reader.source_index);
  source.state.store(SourceState::free, std::memory_order_release);
  subscription.source_generation.fetch_add(1, std::memory_order_release);
  return Progress::freed;
}

/// False if the turn ended before the last reader.
bool revoke_up_to_last(
  Registry & registry, WantedSources & wanted, ReaderPass & pass, const Cluster & cluster,
  TopicDsmHeader & dsm, Turn & turn) {
  bool stopped = false;
  const auto visit = [&](ReaderEntry & entry, uint32_t index) {
    stopped = turn.is_over();
    if (!stopped && entry.active.load(std::memory_order_acquire) != 0) {
      turn.spend(steps_of_a_reader);
      const std::optional<OrphanReader> reader =
        closing::orphan_reader(registry, cluster, dsm, entry);
      const Progress progress =
        reader ? revoke(registry, wanted, pass.endpoint, *reader, entry, turn) : Progress::kept;
      stopped = progress == Progress::turn_over;
      pass.is_any_in_use = pass.is_any_in_use || progress == Progress::in_use;
    } else if (index % free_readers_in_a_step == 0) {
      turn.spend(1);
    }
    dsm.swept_before = stopped ? dsm.swept_before : index + 1;
    return stopped;
  };
  visit_reader_table(cluster, dsm, visit, dsm.swept_before);
  return !stopped;
}

bool is_read(Registry & registry, const Cluster & cluster, TopicDsmHeader & dsm, Turn & turn) {
  bool found = false;
  visit_reader_table(cluster, dsm, [&](const ReaderEntry & entry, uint32_t index) {
    turn.spend(index % free_readers_in_a_step == 0 ? 1 : 0);
    found = entry.active.load(std::memory_order_acquire) != 0 &&
            closing::orphan_reader(registry, cluster, dsm, entry);
    return found;
  });
  return found;
}

/// Continues in the reader table where the last turn of any process ended. `freed` when no reader
/// is left.
Progress revoke_some(
  Registry & registry, WantedSources & wanted, ReaderPass & pass, uint32_t endpoint,
  const Cluster & cluster, TopicDsmHeader & dsm, Turn & turn) {
  if (pass.endpoint != endpoint) {
    pass = {endpoint, dsm.swept_before == 0, false};
  }
  while (true) {
    if (!revoke_up_to_last(registry, wanted, pass, cluster, dsm, turn)) {
      return Progress::turn_over;
    }
    dsm.swept_before = 0;
    if (!is_read(registry, cluster, dsm, turn)) {
      return Progress::freed;
    }
    if (std::exchange(pass.began_first, true)) {
      return std::exchange(pass, {}).is_any_in_use ? Progress::in_use : Progress::kept;
    }
  }
}

/// Frees blocks of a table, last block first, as the turn allows. Returns true when none is left.
/// Each block is freed as the spare block of the endpoint.
template<typename Entry>
bool free_some_of_table(
  Registry & registry, EndpointEntry & entry, const EntryTable<Entry> & table, Turn & turn) {
  while (spare_blocks::free_some(registry, entry.spare, turn)) {
    const auto last = table.take_last();
    if (!last) {
      return true;
    }
    entry.spare.put(
      SpareUse::none, SegmentRef::make(entry.block.cluster(), last->offset), last->bytes);
  }
  return false;
}

/// Frees pieces of generations as the turn allows. Returns true when none is left.
bool free_some_generations(Cluster & cluster, TopicDsmHeader & dsm, Turn & turn) {
  for (GenerationEntry & generation : dsm.generations) {
    while (generation.offset.load() != 0) {
      if (!turn.begin_freeing(generation.whole_bytes())) {
        return false;
      }
      Generation::free_some(cluster, generation);
    }
  }
  return true;
}

/// Frees pieces of the retired landing in `receiver` as the turn allows. True when none is left.
bool free_some_of_retired(
  const Cluster & cluster, TopicDsmHeader & dsm, Cluster & receiver, Turn & turn) {
  for (bool is_free = false; !is_free;) {
    if (!turn.begin_freeing(landing_bytes(dsm))) {
      return false;
    }
    is_free = landings::free_piece_of_retired(cluster, dsm, receiver);
  }
  return true;
}

/// Before the generations, which say how large landings are. True when none is left.
bool free_some_landings(
  Registry & registry, const Cluster & cluster, TopicDsmHeader & dsm, Turn & turn) {
  while (Cluster * const receiver = landings::retire_next(registry, cluster, dsm)) {
    if (!free_some_of_retired(cluster, dsm, *receiver, turn)) {
      return false;
    }
  }
  return true;
}

/// Frees pieces of the head of an endpoint that holds no other memory. Clears the reference in the
/// entry first: if this process dies in between, no repairer follows a reference to freed memory.
Progress free_some_of_head(
  Registry & registry, EndpointEntry & entry, uint64_t bytes, Turn & turn) {
  entry.spare.put(SpareUse::none, std::exchange(entry.block, SegmentRef{}), bytes);
  return spare_blocks::free_some(registry, entry.spare, turn) ? Progress::freed
                                                              : Progress::freed_some;
}

/// True if the publisher of `source` holds no references into the subscription. Its reader entry
/// was removed when the subscription closed, so the topic DSM may be freed since. The publisher's
/// slot is checked first, before the header is read.
bool publisher_is_out(Registry & registry, const SourceEntry & source) {
  const TopicDsmHeader * const dsm = topic_dsm_of(registry, source);
  return dsm == nullptr || dsm->magic.load() != topic_dsm_magic ||
         dsm->phase.load(std::memory_order_seq_cst) % 2 == 0;
}

/// Frees the landing of a publisher that the subscription was the last to read in its cluster, once
/// no thread follows references to it: all are out, or its first piece was freed. False if the turn
/// ended before that.
bool free_landing_of(
  Registry & registry, Cluster & cluster, const SourceEntry & source, bool are_out, Turn & turn) {
  TopicDsmHeader * const dsm =
    source.state.load() == SourceState::free ? nullptr : topic_dsm_of(registry, source);
  const Cluster * const publisher =
    dsm == nullptr ? nullptr : registry.map_cluster(SegmentRef{source.topic_dsm.load()}.cluster());
  if (publisher == nullptr || !landings::has_retired(*publisher, *dsm, cluster.id())) {
    return true;
  }
  return (!are_out && !landings::is_being_freed(*publisher, *dsm, cluster.id())) ||
         free_some_of_retired(*publisher, *dsm, cluster, turn);
}

/// Checks the publishers of the sources, continuing where the last turn of any process ended. A
/// publisher seen outside its phase once stays outside this subscription: it cannot find it any
/// more. `threads_are_out`: see receive_threads_are_out(). `freed` when all were seen.
Progress see_publishers_out(
  Registry & registry, Cluster & cluster, SubscriptionHeader & header, bool threads_are_out,
  Turn & turn) {
  Progress progress = threads_are_out ? Progress::freed : Progress::in_use;
  source_table(cluster, header).visit(header.swept_before, [&](SourceEntry & source, uint32_t i) {
    if (turn.is_over()) {
      progress = Progress::turn_over;
      return true;
    }
    turn.spend(steps_of_a_source);
    const bool are_out = threads_are_out && (source.state.load() == SourceState::free ||
                                             publisher_is_out(registry, source));
    if (!free_landing_of(registry, cluster, source, are_out, turn)) {
      progress = Progress::freed_some;
      return true;
    }
    if (!are_out) {
      progress = Progress::in_use;
      return true;
    }
    header.swept_before = i + 1;
    return false;
  });
  return progress;
}

}  // namespace

Progress sweep_publisher(
  Registry & registry, WantedSources & wanted, ReaderPass & pass, uint32_t endpoint, Turn & turn) {
  EndpointEntry & entry = registry.endpoints()[endpoint];
  if (!spare_blocks::free_some(registry, entry.spare, turn)) {
    return Progress::freed_some;
  }
  Cluster * const cluster = registry.map_cluster(entry.block.cluster());
  auto * const dsm = registry.map<TopicDsmHeader>(entry.block);
  if (cluster == nullptr || dsm == nullptr) {
    return Progress::freed;
  }
  if (entry.slot.state.load() != SlotState::unreachable) {
    const Progress progress = revoke_some(registry, wanted, pass, endpoint, *cluster, *dsm, turn);
    if (progress != Progress::freed) {
      return progress;
    }
    // Dekker with the receive threads: each stores its phase before it looks at the state.
    entry.slot.state.store(SlotState::freeing, std::memory_order_seq_cst);
    if (!receive_threads_are_out(registry)) {
      return Progress::in_use;
    }
    entry.slot.state.store(SlotState::unreachable);
  }
  if (
    !free_some_landings(registry, *cluster, *dsm, turn) ||
    !free_some_generations(*cluster, *dsm, turn) ||
    !free_some_of_table(registry, entry, further_readers(*cluster, *dsm), turn)) {
    return Progress::freed_some;
  }
  return free_some_of_head(registry, entry, header_bytes(*dsm), turn);
}

Progress sweep_subscription(Registry & registry, EndpointEntry & entry, Turn & turn) {
  if (!spare_blocks::free_some(registry, entry.spare, turn)) {
    return Progress::freed_some;
  }
  Cluster * const cluster = registry.map_cluster(entry.block.cluster());
  auto * const header = registry.map<SubscriptionHeader>(entry.block);
  if (cluster == nullptr || header == nullptr) {
    return Progress::freed;
  }
  if (entry.slot.state.load() != SlotState::unreachable) {
    // First: movers follow references to the landings that are then freed.
    const bool are_out = receive_threads_are_out(registry);
    const Progress progress = see_publishers_out(registry, *cluster, *header, are_out, turn);
    if (progress != Progress::freed) {
      return progress;
    }
    header->magic.store(0);
    entry.slot.state.store(SlotState::unreachable);
  }
  if (!free_some_of_table(registry, entry, source_table(*cluster, *header), turn)) {
    return Progress::freed_some;
  }
  return free_some_of_head(registry, entry, block_bytes(*header), turn);
}

}  // namespace manycore::sweeping
