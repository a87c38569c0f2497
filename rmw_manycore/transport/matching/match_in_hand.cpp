// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/matching/match_in_hand.hpp"

#include <optional>

#include "transport/layout/subscription_layout.hpp"
#include "transport/layout/topic_dsm_layout.hpp"
#include "transport/matching/detaching.hpp"
#include "transport/queue/source_table.hpp"
#include "transport/registry/endpoint_blocks.hpp"
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

/// Before the half match is undone: the last reader in a cluster retires the landing there.
void count_readers_of_landings(const PublisherEnd & publisher) {
  landings::forget_readers(publisher.cluster, publisher.header);
  for_each_reader(publisher.cluster, publisher.header, [&](const ReaderEntry & reader) {
    const SegmentRef subscription{reader.subscription.load()};
    landings::count_reader(publisher.cluster, publisher.header, subscription.cluster());
  });
}

/// True for a match that is made, or undone, by half. The reader of an orphan's revoked source
/// stays while its record is read, and is the sweeper's.
bool is_half(Registry & registry, const SourceEntry & source, const PublisherEnd & publisher) {
  const SourceState state = source.state.load();
  return topic_dsm_of(registry, source) == &publisher.header &&
         (state == SourceState::joining ||
          (state == SourceState::revoked && publisher.header.orphan.load() == 0));
}

void undo_half_match(
  Registry & registry, const PublisherEnd & publisher, const SubscriptionEnd & subscription) {
  visit_source_table(
    subscription.cluster, subscription.header, [&](SourceEntry & source, uint32_t) {
      if (is_half(registry, source, publisher)) {
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

/// Once no half match is left, each reader in the table has its source. Counts those of closing
/// subscriptions as well, as count_sources() does.
void count_readers(const PublisherEnd & publisher) {
  uint64_t count = 0;
  for_each_reader(publisher.cluster, publisher.header, [&](const ReaderEntry &) { ++count; });
  publisher.entry.matched_current.store(count);
}

}  // namespace

void repair(Registry & registry) {
  const MatchInHand & in_hand = registry.header().match_in_hand;
  const auto publisher =
    find_end<TopicDsmHeader>(registry, in_hand.publisher.load(), EndpointKind::publisher);
  const auto subscription =
    find_end<SubscriptionHeader>(registry, in_hand.subscription.load(), EndpointKind::subscription);
  if (publisher) {
    count_readers_of_landings(*publisher);
  }
  if (publisher && subscription) {
    undo_half_match(registry, *publisher, *subscription);
  }
  if (publisher) {
    count_readers(*publisher);
  }
  if (subscription) {
    count_sources(registry, *subscription);
  }
}

}  // namespace manycore::match_in_hand
