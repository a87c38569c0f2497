// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/matching/closing.hpp"

#include <algorithm>
#include <optional>

#include "transport/matching/detaching.hpp"
#include "transport/matching/match_in_hand.hpp"
#include "transport/matching/undelivered.hpp"
#include "transport/qos/liveliness.hpp"
#include "transport/queue/source_table.hpp"
#include "transport/registry/endpoint_blocks.hpp"
#include "transport/topic_dsm/reader_table.hpp"
#include "transport/transfer/landings.hpp"

namespace manycore::closing {
namespace {

constexpr uint64_t steps_of_an_entry = 1;
constexpr uint64_t steps_of_a_match = 5;

void count_unmatched(Registry & registry, EndpointEntry & entry) {
  if (entry.matched_current.load() != 0) {
    entry.matched_current.fetch_sub(1);
  }
  notify_event_watchers(registry, entry.process);
}

bool has_readers(const Cluster & cluster, TopicDsmHeader & dsm, Turn & turn) {
  constexpr uint32_t entries_in_a_step = 16;
  bool found = false;
  visit_reader_table(cluster, dsm, [&](const ReaderEntry & entry, uint32_t index) {
    turn.spend(index % entries_in_a_step == 0 ? 1 : 0);
    found = entry.active.load(std::memory_order_acquire) != 0;
    return found;
  });
  return found;
}

/// True if the publisher of a source is gone, and no subscription reads its topic DSM any more.
bool is_unread(Registry & registry, const SourceEntry & source, Turn & turn) {
  TopicDsmHeader * const dsm = topic_dsm_of(registry, source);
  return dsm != nullptr && dsm->orphan.load() != 0 &&
         !has_readers(
           registry.clusters().at(SegmentRef{source.topic_dsm.load()}.cluster()), *dsm, turn);
}

/// `subscription`: slot of that of the source.
void undo_match(Registry & registry, SourceEntry & source, uint32_t subscription) {
  const SourceState state = source.state.load();
  const uint32_t publisher = source.topic_dsm_endpoint.load();
  match_in_hand::note(registry.header(), publisher, subscription);
  if (
    state == SourceState::active && topic_dsm_of(registry, source) != nullptr &&
    registry.endpoints().is_live(publisher)) {
    count_unmatched(registry, registry.endpoints()[publisher]);
  }
  source.state.store(SourceState::revoked, std::memory_order_seq_cst);
  detach_reader(registry, source, registry.endpoints()[subscription].cluster);
}

/// Undoes matches until the turn is over; true when none is left. `closed_before` advances after
/// each match, so if this process dies, at most one is undone twice: its source is then `revoked`,
/// and its reader may still be in the reader table.
bool close_some_of_subscription(
  Registry & registry, uint32_t endpoint, Turn & turn, std::vector<uint32_t> * unread) {
  const EndpointEntry & entry = registry.endpoints()[endpoint];
  Cluster * const cluster = registry.map_cluster(entry.block.cluster());
  auto * const header = registry.map<SubscriptionHeader>(entry.block);
  if (cluster == nullptr || header == nullptr) {
    return true;
  }
  bool stopped = false;
  source_table(*cluster, *header)
    .visit(header->closed_before, [&](SourceEntry & source, uint32_t index) {
      stopped = turn.is_over();
      if (stopped) {
        return true;
      }
      turn.spend(steps_of_an_entry);
      if (source.state.load() != SourceState::free) {
        undo_match(registry, source, endpoint);
        turn.spend(steps_of_a_match);
        if (unread != nullptr && is_unread(registry, source, turn)) {
          unread->push_back(source.topic_dsm_endpoint.load());
        }
      }
      header->closed_before = index + 1;
      return false;
    });
  return !stopped;
}

/// Hints of the last records may not have been pushed (`died`) or may have been displaced. A reader
/// with undelivered records is set to resync, so that the topic DSM does not wait for it forever.
/// False if the turn ended before the reader was notified.
bool notify_of_end(
  Registry & registry, uint32_t publisher, const OrphanReader & reader, bool died, Turn & turn) {
  const std::optional<bool> has_some = may_have_undelivered(reader, turn);
  if (!has_some) {
    return false;
  }
  match_in_hand::note(registry.header(), publisher, reader.endpoint_slot);
  EndpointEntry & subscription = registry.endpoints()[reader.endpoint_slot];
  if (died) {
    note_death(registry.endpoints()[publisher], subscription);
  }
  count_unmatched(registry, subscription);
  if (*has_some) {
    reader.subscription.resync.store(1, std::memory_order_seq_cst);
    notify_watchers(registry, reader.subscription);
  }
  turn.spend(steps_of_a_match);
  return true;
}

/// Notifies the reader of an entry, if there is one. False if the turn ended before that.
bool notify_entry_of_end(
  Registry & registry, uint32_t publisher, const Cluster & cluster, TopicDsmHeader & dsm,
  const ReaderEntry & entry, bool died, Turn & turn) {
  if (entry.active.load(std::memory_order_acquire) == 0) {
    return true;
  }
  const std::optional<OrphanReader> reader = orphan_reader(registry, cluster, dsm, entry);
  return !reader || !registry.endpoints().is_live(reader->endpoint_slot) ||
         notify_of_end(registry, publisher, *reader, died, turn);
}

/// Notifies readers until the turn is over; true when all are notified. `closed_before` advances
/// after each reader, because a reader's match count must not be decremented twice.
bool close_some_of_publisher(Registry & registry, uint32_t endpoint, bool died, Turn & turn) {
  const EndpointEntry & entry = registry.endpoints()[endpoint];
  Cluster * const cluster = registry.map_cluster(entry.block.cluster());
  auto * const dsm = registry.map<TopicDsmHeader>(entry.block);
  if (cluster == nullptr || dsm == nullptr) {
    return true;
  }
  landings::close_all(registry.clusters(), *cluster, *dsm);
  if (died) {
    dsm->phase.store(0, std::memory_order_seq_cst);  // a dead process follows no references
  }
  if (dsm->orphan.load() != 0) {
    return true;
  }
  bool stopped = false;
  visit_reader_table(
    *cluster, *dsm,
    [&](const ReaderEntry & reader_entry, uint32_t index) {
      stopped = turn.is_over();
      if (stopped) {
        return true;
      }
      turn.spend(steps_of_an_entry);
      stopped = !notify_entry_of_end(registry, endpoint, *cluster, *dsm, reader_entry, died, turn);
      if (!stopped) {
        dsm->looked_before = {};  // first: the search for the next reader starts anew
        dsm->closed_before = index + 1;
      }
      return stopped;
    },
    dsm->closed_before);
  if (!stopped) {
    dsm->orphan.store(1, std::memory_order_seq_cst);
  }
  return !stopped;
}

/// Makes the reaper of the process's cluster sweep: it has file descriptors of its own.
void wake_reaper(Registry & registry, uint32_t process) {
  if (!registry.processes().is_live(process)) {
    return;  // damaged entry
  }
  registry.clusters().at(registry.processes()[process].cluster).wake_reaper();
}

}  // namespace

bool close_some(
  Registry & registry, uint32_t endpoint, bool died, Turn & turn, std::vector<uint32_t> * unread) {
  EndpointEntry & entry = registry.endpoints()[endpoint];
  if (entry.slot.state.load() == SlotState::live) {
    entry.slot.state.store(SlotState::closing);
    registry.unlink_endpoint(endpoint);
    registry.header().closing.add(endpoint);
    ++registry.header().closing_count;
  }
  const bool done = entry.kind == EndpointKind::publisher
                      ? close_some_of_publisher(registry, endpoint, died, turn)
                      : close_some_of_subscription(registry, endpoint, turn, unread);
  if (done && entry.slot.state.load() == SlotState::closing) {
    entry.slot.state.store(SlotState::closed);
  }
  return done;
}

bool EndpointsOfProcess::close_some(Turn & turn) {
  for (; !left_.empty(); left_.pop_back()) {
    if (turn.is_over()) {
      return false;
    }
    turn.spend(steps_of_an_entry);
    const uint32_t slot = left_.back();
    if (!is_of_process(registry_.endpoints()[slot], process_)) {
      continue;
    }
    try {
      if (!closing::close_some(registry_, slot, died_, turn)) {
        return false;
      }
    } catch (const ClusterUnmappable & error) {
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
  throw ClusterUnmappable(*obstacle_);
}

}  // namespace manycore::closing
