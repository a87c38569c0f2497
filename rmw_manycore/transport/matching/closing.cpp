// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/matching/closing.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "transport/matching/detaching.hpp"
#include "transport/matching/undelivered.hpp"
#include "transport/qos/liveliness.hpp"
#include "transport/queue/source_table.hpp"
#include "transport/registry/endpoint_blocks.hpp"
#include "transport/topic_dsm/generation.hpp"
#include "transport/topic_dsm/reader_table.hpp"

namespace manycore::closing {
namespace {

/// How much is closed before the registry lock is given back: well under 100 us of work.
class Piece {
public:
  bool is_done() const noexcept { return steps_left_ <= 0; }
  /// A slot or an entry was looked at, which may be a cache miss.
  void look() noexcept { --steps_left_; }
  /// A match was undone, which takes about half a microsecond.
  void undo() noexcept { steps_left_ -= steps_of_match; }

private:
  static constexpr int steps_of_match = 32;
  int steps_left_ = 64 * steps_of_match;
};

void count_unmatched(Registry & registry, EndpointEntry & entry) {
  if (entry.matched_current.load() != 0) {
    entry.matched_current.fetch_sub(1);
  }
  notify_event_watchers(registry, entry.process);
}

void undo_match(Registry & registry, SourceEntry & source) {
  const SourceState state = source.state.load();
  const uint32_t publisher = source.topic_dsm_endpoint.load();
  if (
    state == SourceState::active && topic_dsm_of(registry, source) != nullptr &&
    registry.endpoints().is_live(publisher)) {
    count_unmatched(registry, registry.endpoints()[publisher]);
  }
  source.state.store(SourceState::revoked, std::memory_order_seq_cst);
  detach_reader(registry, source);
}

/// Undoes some matches; true when none is left. `closed_before` moves after each, so a process that
/// dies half way leaves at most one to be undone once more: its source is `revoked` then, and its
/// reader may still be on the reader table.
bool close_some_of_subscription(Registry & registry, EndpointEntry & entry, Piece & piece) {
  Cluster * const cluster = registry.reach(entry.block.cluster());
  auto * const header = registry.reach<SubscriptionHeader>(entry.block);
  if (cluster == nullptr || header == nullptr) {
    return true;
  }
  bool stopped = false;
  source_table(*cluster, *header)
    .visit(header->closed_before, [&](SourceEntry & source, uint32_t index) {
      stopped = piece.is_done();
      if (stopped) {
        return true;
      }
      piece.look();
      if (source.state.load() != SourceState::free) {
        undo_match(registry, source);
        piece.undo();
      }
      header->closed_before = index + 1;
      return false;
    });
  return !stopped;
}

/// Nothing when the entry leads nowhere. Throws OutOfReach.
std::optional<OrphanReader> follow(
  Registry & registry, const Cluster & cluster, TopicDsmHeader & dsm, const ReaderEntry & reader) {
  auto * const source = registry.reach<SourceEntry>(SegmentRef{reader.source.load()});
  auto * const header = registry.reach<SubscriptionHeader>(SegmentRef{reader.subscription.load()});
  const uint32_t slot = reader.endpoint.load();
  if (source == nullptr || header == nullptr || slot >= registry.endpoints().high_water()) {
    return std::nullopt;
  }
  return OrphanReader{
    cluster, dsm, *header, *source, registry.endpoints()[slot], slot, reader.source_index.load()};
}

/// Hints of its last records may never have been pushed (`died`), or may have been displaced: a
/// reader that misses something is told to look, so that the topic DSM does not wait for it for
/// ever.
void tell_of_end(
  Registry & registry, const EndpointEntry & publisher, const OrphanReader & reader, bool died) {
  EndpointEntry & subscription = registry.endpoints()[reader.endpoint_slot];
  if (died) {
    note_death(publisher, subscription);
  }
  count_unmatched(registry, subscription);
  if (has_undelivered(reader)) {
    reader.subscription.resync.store(1, std::memory_order_seq_cst);
    notify_watchers(registry, reader.subscription);
  }
}

/// Tells some readers; true when all know. `closed_before` moves after each: what is counted down
/// for a reader may not be counted down again.
bool close_some_of_publisher(Registry & registry, EndpointEntry & entry, bool died, Piece & piece) {
  Cluster * const cluster = registry.reach(entry.block.cluster());
  auto * const dsm = registry.reach<TopicDsmHeader>(entry.block);
  if (cluster == nullptr || dsm == nullptr) {
    return true;
  }
  if (died) {
    dsm->phase.store(0, std::memory_order_seq_cst);  // the dead follow no references
  }
  if (dsm->orphan.load() != 0) {
    return true;
  }
  bool stopped = false;
  visit_reader_table(
    *cluster, *dsm,
    [&](ReaderEntry & reader_entry, uint32_t index) {
      stopped = piece.is_done();
      if (stopped) {
        return true;
      }
      piece.look();
      if (reader_entry.active.load(std::memory_order_acquire) != 0) {
        const std::optional<OrphanReader> reader = follow(registry, *cluster, *dsm, reader_entry);
        if (reader && registry.endpoints().is_live(reader->endpoint_slot)) {
          tell_of_end(registry, entry, *reader, died);
        }
        piece.undo();
      }
      dsm->closed_before = index + 1;
      return false;
    },
    dsm->closed_before);
  if (!stopped) {
    dsm->orphan.store(1, std::memory_order_seq_cst);
  }
  return !stopped;
}

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
/// instead; false while it is not done.
bool revoke(
  Registry & registry, WantedSources & wanted, const OrphanReader & reader, ReaderEntry & entry) {
  SourceEntry & source = reader.source;
  if (source.state.load() == SourceState::active) {
    if (wanted.contain(reader)) {
      return false;
    }
    // Dekker with the claim: the reader stores `reading` before it looks at the state.
    source.state.store(SourceState::revoked, std::memory_order_seq_cst);
  }
  if (source.reading.load(std::memory_order_seq_cst) != no_record) {
    return false;
  }
  count_undelivered(registry, reader);
  // Off the reader table before the source is free for another match: should this process die in
  // between, the next sweep must not take that match for this one.
  free_reader_entry(reader.cluster, reader.dsm, entry);
  SubscriptionHeader & subscription = reader.subscription;
  subscription.free_source_from = std::min(subscription.free_source_from, reader.source_index);
  source.state.store(SourceState::free, std::memory_order_release);
  subscription.source_generation.fetch_add(1, std::memory_order_release);
  return true;
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

bool sweep_publisher(Registry & registry, WantedSources & wanted, EndpointEntry & entry) {
  Cluster * const cluster = registry.reach(entry.block.cluster());
  auto * const dsm = registry.reach<TopicDsmHeader>(entry.block);
  if (cluster == nullptr || dsm == nullptr) {
    return true;
  }
  bool all_revoked = true;
  for_each_reader(*cluster, *dsm, [&](ReaderEntry & entry_of_reader) {
    const std::optional<OrphanReader> reader = follow(registry, *cluster, *dsm, entry_of_reader);
    all_revoked = (!reader || revoke(registry, wanted, *reader, entry_of_reader)) && all_revoked;
  });
  if (!all_revoked) {
    return false;
  }
  // Dekker with the receive threads: each stores its phase before it looks at the state.
  entry.slot.state.store(SlotState::freeing, std::memory_order_seq_cst);
  if (!receive_threads_are_out(registry)) {
    return false;
  }
  entry.block = SegmentRef{};  // should this process die, no repairer looks into what is given back
  free_topic_dsm(*cluster, *dsm);
  return true;
}

/// True when the publisher behind `source` holds no references into the subscription. The reader
/// was taken off the reader table when the subscription closed, so the topic DSM may have been
/// freed since: the publisher's slot says whether its header is still a header, before it is read.
bool publisher_is_out(Registry & registry, const SourceEntry & source) {
  const TopicDsmHeader * const dsm = topic_dsm_of(registry, source);
  return dsm == nullptr || dsm->magic.load() != topic_dsm_magic ||
         dsm->phase.load(std::memory_order_seq_cst) % 2 == 0;
}

bool sweep_subscription(Registry & registry, EndpointEntry & entry) {
  Cluster * const cluster = registry.reach(entry.block.cluster());
  auto * const header = registry.reach<SubscriptionHeader>(entry.block);
  if (cluster == nullptr || header == nullptr) {
    return true;
  }
  bool out = receive_threads_are_out(registry);
  visit_source_table(*cluster, *header, [&](SourceEntry & source, uint32_t) {
    out = out && (source.state.load() == SourceState::free || publisher_is_out(registry, source));
    return !out;
  });
  if (!out) {
    return false;
  }
  header->magic.store(0);
  const uint64_t offset = std::exchange(entry.block, SegmentRef{}).offset();
  free_table(*cluster, source_table(*cluster, *header));
  cluster->free(
    offset, sizeof(SubscriptionHeader) + (uint64_t{8} << (header->slot_count_log2 & 31)));
  return true;
}

/// Has the reaper of a process's cluster sweep: it has descriptors of its own.
void wake_reaper(Registry & registry, uint32_t process) {
  if (!registry.processes().is_live(process)) {
    return;  // a damaged entry
  }
  registry.clusters().at(registry.processes()[process].cluster).wake_reaper();
}

bool close_within(Registry & registry, uint32_t endpoint, bool died, Piece & piece) {
  EndpointEntry & entry = registry.endpoints()[endpoint];
  if (entry.slot.state.load() == SlotState::live) {
    entry.slot.state.store(SlotState::closing);
    registry.unlink_endpoint(endpoint);
    ++registry.header().closing_count;
  }
  const bool done = entry.kind == EndpointKind::publisher
                      ? close_some_of_publisher(registry, entry, died, piece)
                      : close_some_of_subscription(registry, entry, piece);
  if (done && entry.slot.state.load() == SlotState::closing) {
    entry.slot.state.store(SlotState::closed);
  }
  return done;
}

}  // namespace

bool close_some(Registry & registry, uint32_t endpoint, bool died) {
  Piece piece;
  return close_within(registry, endpoint, died, piece);
}

bool EndpointsOfProcess::close_some() {
  Piece piece;
  for (; next_ < registry_.endpoints().high_water(); ++next_) {
    if (piece.is_done()) {
      return false;
    }
    piece.look();
    const EndpointEntry & entry = registry_.endpoints()[next_];
    if (entry.process != process_ || entry.slot.state.load() == SlotState::free) {
      continue;
    }
    try {
      if (!close_within(registry_, next_, died_, piece)) {
        return false;
      }
    } catch (const OutOfReach & error) {
      obstacle_.emplace(error);
    }
  }
  return true;
}

void EndpointsOfProcess::require_all_closed() {
  if (!obstacle_) {
    return;
  }
  if (!died_) {
    wake_reaper(registry_, process_);
  }
  throw OutOfReach(*obstacle_);
}

namespace {

/// Left by a process that lives, as a cluster was out of its reach; or by one that is dying, thread
/// by thread. What the dead leave is the reaper's.
bool is_left_closing(Registry & registry, const EndpointEntry & entry) {
  return entry.slot.state.load() == SlotState::closing &&
         registry.processes().is_live(entry.process) && registry.lifelines().is_held(entry.process);
}

/// True when the endpoint's memory is free. Throws OutOfReach.
bool sweep_endpoint(Registry & registry, WantedSources & wanted, uint32_t slot) {
  EndpointEntry & entry = registry.endpoints()[slot];
  if (is_left_closing(registry, entry)) {
    close_some(registry, slot, false);
  }
  const SlotState state = entry.slot.state.load();
  if (state != SlotState::closed && state != SlotState::freeing) {
    return false;
  }
  return entry.kind == EndpointKind::publisher ? sweep_publisher(registry, wanted, entry)
                                               : sweep_subscription(registry, entry);
}

}  // namespace

bool sweep(Registry & registry) {
  RegistryHeader & header = registry.header();
  bool reaches_all = true;
  WantedSources wanted(registry);
  for (uint32_t slot = 0; header.closing_count != 0 && slot < registry.endpoints().high_water();
       ++slot) {
    try {
      if (sweep_endpoint(registry, wanted, slot)) {
        registry.endpoints().give_back(slot);
        --header.closing_count;
      }
    } catch (const OutOfReach &) {
      reaches_all = false;
    }
  }
  return reaches_all;
}

void leave(Registry & registry, uint32_t endpoint) noexcept {
  const Slot & slot = registry.endpoints()[endpoint].slot;
  const uint32_t incarnation = slot.incarnation.load();
  try {
    bool closed = false;
    while (!closed) {
      const Registry::Lock lock(registry, registry.parting_wait_ns());
      if (slot.state.load() == SlotState::free || slot.incarnation.load() != incarnation) {
        break;  // meanwhile others closed and freed it
      }
      const uint32_t process = registry.endpoints()[endpoint].process;
      try {
        closed = close_some(registry, endpoint, false);
      } catch (const OutOfReach &) {
        closed = true;  // as far as this process can; it is out of the sweep's reach, too
      }
      if (closed && !sweep(registry)) {
        wake_reaper(registry, process);
      }
    }
  } catch (const std::exception &) {
    // The registry stayed locked: this endpoint is closed when its process leaves or ends.
  }
  registry.graph_changed();
}

}  // namespace manycore::closing
