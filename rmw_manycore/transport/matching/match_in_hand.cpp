// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/matching/match_in_hand.hpp"

#include <optional>

#include "transport/layout/subscription_layout.hpp"
#include "transport/layout/topic_dsm_layout.hpp"
#include "transport/matching/detaching.hpp"
#include "transport/queue/source_table.hpp"
#include "transport/registry/endpoint_blocks.hpp"
#include "transport/registry/snapshot.hpp"
#include "transport/topic_dsm/reader_table.hpp"
#include "transport/transfer/landings.hpp"

namespace manycore::match_in_hand {
namespace {

/// An endpoint with its memory.
template<typename Header>
struct End {
  EndpointEntry & entry;
  const Cluster & cluster;
  Header & header;
};

/// Nothing if the slot has no endpoint of this kind by now: then there is nothing to repair.
template<typename Header>
std::optional<End<Header>> find_end(Registry & registry, uint32_t slot, EndpointKind kind) {
  if (slot >= registry.endpoints().high_water()) {
    return std::nullopt;
  }
  EndpointEntry & entry = registry.endpoints()[slot];
  const Cluster * const cluster = registry.clusters().find(entry.block.cluster());
  auto * const header = registry.clusters().find<Header>(entry.block);
  if (
    entry.slot.state.load(std::memory_order_acquire) == SlotState::free || entry.kind != kind ||
    cluster == nullptr || header == nullptr) {
    return std::nullopt;
  }
  return End<Header>{entry, *cluster, *header};
}

using PublisherEnd = End<TopicDsmHeader>;
using SubscriptionEnd = End<SubscriptionHeader>;

void undo_half_match(Registry & registry, const SubscriptionEnd & subscription) {
  visit_source_table(
    subscription.cluster, subscription.header, [&](SourceEntry & source, uint32_t) {
      if (source.state.load() == SourceState::joining) {
        detach_reader(registry, source, subscription.entry.cluster);
        // Not `free`: the publisher may have seen the reader, so its phase must be checked through
        // this entry when the subscription is freed.
        source.state.store(SourceState::revoked, std::memory_order_seq_cst);
      }
      return false;
    });
}

/// A closing publisher decrements reader by reader.
bool counts_down(Registry & registry, TopicDsmHeader & dsm, const SourceEntry & source) {
  if (dsm.closed_before == 0) {
    return false;
  }
  const SegmentRef ref{source.reader.load()};
  const Cluster * const cluster = registry.clusters().find(ref.cluster());
  const auto * const reader = registry.clusters().find<ReaderEntry>(ref);
  const auto index = cluster == nullptr || reader == nullptr
                       ? std::nullopt
                       : index_of_reader(*cluster, dsm, *reader);
  return index && *index < dsm.closed_before;
}

/// Counts the match with a closing publisher as well, until it is undone: only then the count is
/// decremented.
void count_sources(Registry & registry, const SubscriptionEnd & subscription) {
  uint64_t count = 0;
  visit_source_table(
    subscription.cluster, subscription.header, [&](const SourceEntry & source, uint32_t) {
      TopicDsmHeader * const dsm = topic_dsm_of(registry, source);
      if (
        source.state.load() == SourceState::active && dsm != nullptr && dsm->orphan.load() == 0 &&
        !counts_down(registry, *dsm, source)) {
        ++count;
      }
      return false;
    });
  subscription.entry.matched_current.store(count);
}

/// A match is made by its reader first and undone by its source first, so a reader in the table may
/// have no active source. That can only be the one in hand.
bool has_source(Registry & registry, const PublisherEnd & publisher, const ReaderEntry & reader) {
  if (reader.endpoint.load() != registry.header().match_in_hand.subscription.load()) {
    return true;
  }
  const auto * const source = registry.clusters().find<SourceEntry>(SegmentRef{reader.source});
  return source != nullptr && source->state.load() == SourceState::active &&
         source->reader.load() == publisher.cluster.ref_of(&reader).word &&
         source->topic_dsm.load() == publisher.entry.block.word;
}

/// Counts those of closing subscriptions as well, as count_sources() does.
void count_readers(Registry & registry, const PublisherEnd & publisher) {
  uint64_t count = 0;
  landings::forget_readers(publisher.cluster, publisher.header);
  for_each_reader(publisher.cluster, publisher.header, [&](const ReaderEntry & reader) {
    const SegmentRef subscription{reader.subscription.load()};
    landings::count_reader(publisher.cluster, publisher.header, subscription.cluster());
    count += has_source(registry, publisher, reader) ? 1 : 0;
  });
  publisher.entry.matched_current.store(count);
}

void populate_table_of(Registry & registry, uint32_t slot) noexcept {
  const EntryCopy<EndpointEntry> entry(registry.endpoints(), slot);
  const SegmentRef block = (*entry).block;
  const Cluster * const cluster = registry.clusters().find(block.cluster());
  auto * const dsm = registry.clusters().find<TopicDsmHeader>(block);
  auto * const subscription = registry.clusters().find<SubscriptionHeader>(block);
  const auto populate = [&](uint64_t offset, uint64_t bytes) { cluster->populate(offset, bytes); };
  if ((*entry).kind == EndpointKind::publisher && dsm != nullptr) {
    further_readers(*cluster, *dsm).visit_memory(populate);
  } else if (subscription != nullptr) {
    source_table(*cluster, *subscription).visit_memory(populate);
  }
}

}  // namespace

void prepare_repair(Registry & registry) noexcept {
  const MatchInHand & in_hand = registry.header().match_in_hand;
  for (const uint32_t slot : {in_hand.publisher.load(), in_hand.subscription.load()}) {
    if (slot < registry.endpoints().high_water()) {
      populate_table_of(registry, slot);
    }
  }
}

void repair(Registry & registry) {
  const MatchInHand & in_hand = registry.header().match_in_hand;
  const auto publisher =
    find_end<TopicDsmHeader>(registry, in_hand.publisher.load(), EndpointKind::publisher);
  const auto subscription =
    find_end<SubscriptionHeader>(registry, in_hand.subscription.load(), EndpointKind::subscription);
  if (subscription) {
    undo_half_match(registry, *subscription);
    count_sources(registry, *subscription);
  }
  if (publisher) {
    count_readers(registry, *publisher);
  }
}

}  // namespace manycore::match_in_hand
