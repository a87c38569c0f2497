// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/matching/closing.hpp"

#include "transport/layout/subscription_layout.hpp"
#include "transport/matching/orphans.hpp"
#include "transport/peers/endpoint_terms.hpp"
#include "transport/registry/endpoint_blocks.hpp"
#include "transport/registry/topic_rows.hpp"
#include "transport/topic_dsm/waiting_publisher.hpp"
#include "transport/transfer/transfer.hpp"

namespace manycore::closing {
namespace {

void begin_publisher(Registry & registry, EndpointEntry & entry) {
  Cluster * const cluster = registry.map_cluster(entry.block.cluster());
  auto * const dsm = registry.map<TopicDsmHeader>(entry.block);
  if (cluster == nullptr || dsm == nullptr) {
    return;  // damaged
  }
  transfer::end(registry.clusters(), *cluster, *dsm);
  orphans::give_seats_to_readers_of_history(registry, *cluster, entry, *dsm);
}

/// Wakes the processes of peers that wait for events, and publishers that wait for a closed
/// subscription (KEEP_ALL).
void notify_peers(Registry & registry, const EndpointEntry & entry) {
  const EndpointTerms terms(entry);
  const EndpointKind kind =
    entry.kind == EndpointKind::publisher ? EndpointKind::subscription : EndpointKind::publisher;
  for_each_row(registry, entry.topic, kind, [&](EndpointEntry & other, uint32_t) {
    if (!is_live(other) || fit_of(terms, other).kind != Fit::Kind::matched) {
      return;
    }
    notify_event_watchers(registry, other.process.load());
    TopicDsmHeader * const dsm = kind == EndpointKind::publisher
                                   ? registry.clusters().find<TopicDsmHeader>(other.block)
                                   : nullptr;
    if (dsm != nullptr) {
      notify_waiting_publisher(*dsm);
    }
  });
}

/// Stored in this order: how an endpoint ended is known once its row is not live.
void close_row(Registry & registry, uint32_t endpoint, bool died) {
  EndpointEntry & entry = registry.endpoints()[endpoint];
  RegistryHeader & header = registry.header();
  entry.died.store(died ? 1 : 0);
  entry.closed_order = ++header.last_order;
  entry.slot.state.store(SlotState::closed, std::memory_order_seq_cst);
  registry.raise_changes(entry.topic_hash);
  header.closing.add(endpoint);
  ++header.closing_count;
}

}  // namespace

void close(Registry & registry, uint32_t endpoint, bool died, std::vector<uint32_t> & unwanted) {
  EndpointEntry & entry = registry.endpoints()[endpoint];
  const bool is_publisher = entry.kind == EndpointKind::publisher;
  if (!is_live(entry)) {
    return;
  }
  registry.map_cluster(entry.block.cluster());
  if (is_publisher) {
    begin_publisher(registry, entry);
  }
  close_row(registry, endpoint, died);
  notify_peers(registry, entry);
  try {
    orphans::cut(registry, entry.topic, unwanted);
  } catch (const ClusterUnmappable &) {
    // The sweep of this endpoint finds it `in_use`, and the reaper, which has descriptors of its
    // own, goes on.
  }
}

}  // namespace manycore::closing
