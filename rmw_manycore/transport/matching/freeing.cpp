// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/matching/freeing.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "transport/queue/source_table.hpp"
#include "transport/registry/endpoint_blocks.hpp"
#include "transport/topic_dsm/generation.hpp"
#include "transport/topic_dsm/reader_table.hpp"

namespace manycore::sweeping {
namespace {

using closing::OrphanReader;

constexpr uint64_t steps_of_a_reader = 8;
constexpr uint64_t steps_of_a_source = 2;
constexpr uint32_t free_readers_in_a_step = 16;

/// True when no receive thread follows references that it loaded before now. The dead follow none:
/// one that was killed in its phase has a successor only if its cluster has a process. Throws
/// OutOfReach when the phase of one that lives is not to be seen.
bool receive_threads_are_out(Registry & registry) {
  const uint64_t present = registry.header().clusters_present.load();
  for (uint32_t id = 1; id <= max_clusters; ++id) {
    if ((present >> (id - 1) & 1) == 0) {
      continue;
    }
    const Cluster * const cluster = registry.clusters().find(id);
    const bool may_be_in_phase =
      cluster == nullptr || cluster->header().phase.load(std::memory_order_seq_cst) % 2 != 0;
    if (may_be_in_phase && registry.lifelines().is_held(receive_thread_line + id)) {
      registry.reach(id);
      return false;
    }
  }
  return true;
}

/// Takes the topic DSM away from a reader that is done with it, or wants newer messages of others
/// instead.
Progress revoke(
  Registry & registry, WantedSources & wanted, const OrphanReader & reader, ReaderEntry & entry,
  Turn & turn) {
  SourceEntry & source = reader.source;
  if (source.state.load() == SourceState::active) {
    const std::optional<bool> is_wanted = wanted.contain(reader, turn);
    if (!is_wanted) {
      return Progress::turn_over;
    }
    if (*is_wanted) {
      return Progress::blocked;
    }
    // Dekker with the claim: the reader stores `reading` before it looks at the state.
    source.state.store(SourceState::revoked, std::memory_order_seq_cst);
  }
  if (source.reading.load(std::memory_order_seq_cst) != no_record) {
    return Progress::blocked;
  }
  closing::count_undelivered(registry, reader);
  // Off the reader table before the source is free for another match: should this process die in
  // between, the next sweep must not take that match for this one.
  free_reader_entry(reader.cluster, reader.dsm, entry);
  SubscriptionHeader & subscription = reader.subscription;
  subscription.free_source_from = std::min(subscription.free_source_from, reader.source_index);
  source.state.store(SourceState::free, std::memory_order_release);
  subscription.source_generation.fetch_add(1, std::memory_order_release);
  return Progress::freed;
}

/// False when the turn was over before the last reader.
bool revoke_up_to_last(
  Registry & registry, WantedSources & wanted, const Cluster & cluster, TopicDsmHeader & dsm,
  Turn & turn) {
  bool stopped = false;
  const auto visit = [&](ReaderEntry & entry, uint32_t index) {
    stopped = turn.is_over();
    if (!stopped && entry.active.load(std::memory_order_acquire) != 0) {
      turn.spend(steps_of_a_reader);
      const std::optional<OrphanReader> reader =
        closing::orphan_reader(registry, cluster, dsm, entry);
      stopped = reader && revoke(registry, wanted, *reader, entry, turn) == Progress::turn_over;
    } else if (index % free_readers_in_a_step == 0) {
      turn.spend(1);
    }
    dsm.swept_before = stopped ? dsm.swept_before : index + 1;
    return stopped;
  };
  visit_reader_table(cluster, dsm, visit, dsm.swept_before);
  return !stopped;
}

bool is_read(Registry & registry, const Cluster & cluster, TopicDsmHeader & dsm) {
  bool found = false;
  visit_reader_table(cluster, dsm, [&](const ReaderEntry & entry, uint32_t) {
    found = entry.active.load(std::memory_order_acquire) != 0 &&
            closing::orphan_reader(registry, cluster, dsm, entry);
    return found;
  });
  return found;
}

/// Goes through the reader table from where the last turn of any process ended; `freed` when no
/// reader is on it any more.
Progress revoke_some(
  Registry & registry, WantedSources & wanted, ReaderPass & pass, uint32_t endpoint,
  const Cluster & cluster, TopicDsmHeader & dsm, Turn & turn) {
  if (pass.endpoint != endpoint) {
    pass = {endpoint, dsm.swept_before == 0};
  }
  while (true) {
    if (!revoke_up_to_last(registry, wanted, cluster, dsm, turn)) {
      return Progress::turn_over;
    }
    dsm.swept_before = 0;
    if (!is_read(registry, cluster, dsm)) {
      return Progress::freed;
    }
    if (std::exchange(pass.began_first, true)) {
      pass = {};
      return Progress::blocked;
    }
  }
}

template<typename Entry>
void free_table(Cluster & cluster, const EntryTable<Entry> & table) {
  table.visit_memory([&](uint64_t offset, uint64_t bytes) { cluster.free(offset, bytes); });
}

void free_topic_dsm(Cluster & cluster, TopicDsmHeader & dsm) {
  for (GenerationEntry & generation : dsm.generations) {
    if (generation.offset.load() != 0) {
      Generation::free(cluster, generation);
    }
  }
  free_table(cluster, further_readers(cluster, dsm));
  cluster.free(cluster.ref_of(&dsm).offset(), sizeof dsm);
}

/// True when the publisher behind `source` holds no references into the subscription. The reader
/// was taken off the reader table when the subscription closed, so the topic DSM may have been
/// freed since: the publisher's slot says whether its header is still a header, before it is read.
bool publisher_is_out(Registry & registry, const SourceEntry & source) {
  const TopicDsmHeader * const dsm = topic_dsm_of(registry, source);
  return dsm == nullptr || dsm->magic.load() != topic_dsm_magic ||
         dsm->phase.load(std::memory_order_seq_cst) % 2 == 0;
}

/// Looks at the publishers behind the sources, from where the last turn of any process ended. One
/// that was seen out once stays out: it finds the subscription no more. `freed` when all are.
Progress see_publishers_out(
  Registry & registry, const Cluster & cluster, SubscriptionHeader & header, Turn & turn) {
  Progress progress = Progress::freed;
  source_table(cluster, header).visit(header.swept_before, [&](SourceEntry & source, uint32_t i) {
    if (turn.is_over()) {
      progress = Progress::turn_over;
      return true;
    }
    turn.spend(steps_of_a_source);
    if (source.state.load() != SourceState::free && !publisher_is_out(registry, source)) {
      progress = Progress::blocked;
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
  Cluster * const cluster = registry.reach(entry.block.cluster());
  auto * const dsm = registry.reach<TopicDsmHeader>(entry.block);
  if (cluster == nullptr || dsm == nullptr) {
    return Progress::freed;
  }
  const Progress progress = revoke_some(registry, wanted, pass, endpoint, *cluster, *dsm, turn);
  if (progress != Progress::freed) {
    return progress;
  }
  // Dekker with the receive threads: each stores its phase before it looks at the state.
  entry.slot.state.store(SlotState::freeing, std::memory_order_seq_cst);
  if (!receive_threads_are_out(registry)) {
    return Progress::blocked;
  }
  entry.block = SegmentRef{};  // should this process die, no repairer looks into what is given back
  free_topic_dsm(*cluster, *dsm);
  return Progress::freed;
}

Progress sweep_subscription(Registry & registry, EndpointEntry & entry, Turn & turn) {
  Cluster * const cluster = registry.reach(entry.block.cluster());
  auto * const header = registry.reach<SubscriptionHeader>(entry.block);
  if (cluster == nullptr || header == nullptr) {
    return Progress::freed;
  }
  const Progress progress = see_publishers_out(registry, *cluster, *header, turn);
  if (progress != Progress::freed) {
    return progress;
  }
  if (!receive_threads_are_out(registry)) {
    return Progress::blocked;
  }
  header->magic.store(0);
  const uint64_t offset = std::exchange(entry.block, SegmentRef{}).offset();
  free_table(*cluster, source_table(*cluster, *header));
  cluster->free(
    offset, sizeof(SubscriptionHeader) + (uint64_t{8} << (header->slot_count_log2 & 31)));
  return Progress::freed;
}

}  // namespace manycore::sweeping
