// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/matching/closing.hpp"

#include "transport/matching/detaching.hpp"
#include "transport/matching/orphans.hpp"
#include "transport/qos/liveliness.hpp"
#include "transport/queue/source_table.hpp"
#include "transport/registry/endpoint_blocks.hpp"
#include "transport/transfer/transfer.hpp"

namespace manycore::closing {
namespace {

void count_unmatched(Registry & registry, EndpointEntry & entry) {
  if (entry.matched_current.load() != 0) {
    entry.matched_current.fetch_sub(1);
  }
  notify_event_watchers(registry, entry.process);
}

/// A source that is `revoked` is not counted any more: if this process dies midway, the match is
/// undone once.
void undo_match(
  Registry & registry, SourceEntry & source, uint32_t receiver, std::vector<uint32_t> & unread) {
  const uint32_t publisher = source.topic_dsm_endpoint.load();
  const TopicDsmHeader * const dsm = topic_dsm_of(registry, source);
  if (dsm != nullptr && dsm->orphan.load() != 0) {
    unread.push_back(publisher);
  } else if (dsm != nullptr && source.state.load() == SourceState::active) {
    count_unmatched(registry, registry.endpoints()[publisher]);
  }
  source.state.store(SourceState::revoked, std::memory_order_seq_cst);
  detach_reader(registry, source, receiver);
  if (dsm != nullptr) {
    // Any later value shows that the publisher has looked at its reader table since.
    source.accounted.store(dsm->phase.load(std::memory_order_seq_cst));
  }
}

void close_subscription(
  Registry & registry, const EndpointEntry & entry, std::vector<uint32_t> & unread) {
  Cluster * const cluster = registry.map_cluster(entry.block.cluster());
  auto * const header = registry.map<SubscriptionHeader>(entry.block);
  if (cluster == nullptr || header == nullptr) {
    return;
  }
  visit_source_table(*cluster, *header, [&](SourceEntry & source, uint32_t) {
    if (source.state.load() != SourceState::free) {
      undo_match(registry, source, entry.cluster, unread);
    }
    return false;
  });
}

/// Hints of the last records may not have been pushed (`died`) or may have been displaced. A reader
/// with undelivered records is set to resync, so that the topic DSM does not wait for it forever.
void notify_of_end(
  Registry & registry, const EndpointEntry & publisher, const orphans::Reader & reader, bool died,
  bool has_untaken) {
  EndpointEntry & subscription = registry.endpoints()[reader.endpoint_slot];
  if (died) {
    note_death(publisher, subscription);
  }
  count_unmatched(registry, subscription);
  if (has_untaken) {
    reader.subscription.resync.store(1, std::memory_order_seq_cst);
    notify_watchers(registry, reader.subscription);
  }
}

/// The publisher counts as matched until it is an orphan: if this process dies midway, a repair
/// counts the matches of its readers anew, and they are notified once more.
void close_publisher(
  Registry & registry, const EndpointEntry & entry, bool died, std::vector<uint32_t> & unread) {
  Cluster * const cluster = registry.map_cluster(entry.block.cluster());
  auto * const dsm = registry.map<TopicDsmHeader>(entry.block);
  if (cluster == nullptr || dsm == nullptr) {
    return;
  }
  transfer::end(registry.clusters(), *cluster, *dsm);
  if (died) {
    dsm->phase.store(0, std::memory_order_seq_cst);  // a dead process follows no references
  }
  if (dsm->orphan.load() != 0) {
    return;
  }
  const orphans::Untaken untaken(*cluster, *dsm);
  bool is_read = false;
  std::vector<orphans::Reader> readers;  // all are mapped before anything is changed
  orphans::for_each_reader(
    registry, *cluster, *dsm,
    [&](const orphans::Reader & reader, ReaderEntry &) { readers.push_back(reader); });
  for (const orphans::Reader & reader : readers) {
    if (registry.endpoints().is_live(reader.endpoint_slot)) {
      const bool has_untaken = untaken.of(reader) != 0;
      notify_of_end(registry, entry, reader, died, has_untaken);
      is_read = is_read || has_untaken;
    }
  }
  dsm->orphan.store(1, std::memory_order_seq_cst);
  if (is_read) {
    orphans::cut(registry, entry.topic, unread);
  }
}

/// Publishers that are gone are found by topic.
void leave_chain(Registry & registry, uint32_t endpoint) {
  EndpointEntry & entry = registry.endpoints()[endpoint];
  registry.unlink_endpoint(endpoint, Registry::Chain::live);
  if (entry.kind == EndpointKind::publisher) {
    entry.order = ++registry.header().last_order;
    registry.link_endpoint(endpoint, Registry::Chain::orphans);
  }
}

}  // namespace

void close(Registry & registry, uint32_t endpoint, bool died, std::vector<uint32_t> & unread) {
  EndpointEntry & entry = registry.endpoints()[endpoint];
  if (entry.slot.state.load() == SlotState::live) {
    entry.died.store(died ? 1 : 0);
    entry.slot.state.store(SlotState::closing);
    registry.raise_changes(entry.topic_hash);
    leave_chain(registry, endpoint);
    registry.header().closing.add(endpoint);
    ++registry.header().closing_count;
  }
  if (entry.kind == EndpointKind::publisher) {
    close_publisher(registry, entry, died, unread);
  } else {
    close_subscription(registry, entry, unread);
  }
  if (entry.slot.state.load() == SlotState::closing) {
    entry.slot.state.store(SlotState::closed);
  }
}

}  // namespace manycore::closing
