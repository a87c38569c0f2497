// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/matching/free_entries.hpp"

#include "platform/error.hpp"
#include "transport/queue/source_table.hpp"
#include "transport/topic_dsm/reader_table.hpp"

namespace manycore::matching {

/// Returns the first of the new entries, or nullptr if a block is needed.
template<typename Entry>
Entry * FreeEntries::grow(const EntryTable<Entry> & table, Cluster & cluster) {
  const uint64_t bytes = table.next_block_bytes();
  if (bytes <= BlockInHand::max_bytes_at_once) {
    return &table.grow(cluster.ref_of(&cluster.allocate_cleared<Entry>(bytes)).offset());
  }
  const NeededBlock needed{cluster.id(), bytes, bytes, false};
  if (hand_ == nullptr || !hand_->has(needed)) {
    needed_ = needed;
    return nullptr;
  }
  Entry & first = table.grow(hand_->block().offset());
  hand_->let_go();
  return &first;
}

FreeEntries::Source FreeEntries::source(Cluster & cluster, SubscriptionHeader & subscription) {
  const EntryTable<SourceEntry> table = source_table(cluster, subscription);
  SourceEntry * found = nullptr;
  table.visit(subscription.free_source_from, [&](SourceEntry & entry, uint32_t) {
    found = entry.state.load() == SourceState::free ? &entry : nullptr;
    return found != nullptr;
  });
  if (found == nullptr) {
    found = grow(table, cluster);
  }
  if (found == nullptr) {
    return {};
  }
  const uint32_t index = table.index_of(*found).value_or(Hint::source_limit);
  if (index >= Hint::source_limit) {
    throw Error(ErrorCode::no_space, "a subscription has more than 16,000 publishers");
  }
  subscription.free_source_from = index;
  return {found, index};
}

ReaderEntry * FreeEntries::reader(Cluster & cluster, TopicDsmHeader & dsm) {
  ReaderEntry * found = nullptr;
  visit_reader_table(
    cluster, dsm,
    [&](ReaderEntry & entry, uint32_t) {
      found = entry.active.load() == 0 ? &entry : nullptr;
      return found != nullptr;
    },
    dsm.free_reader_from);
  if (found == nullptr) {
    found = grow(further_readers(cluster, dsm), cluster);
  }
  if (found != nullptr) {
    dsm.free_reader_from = index_of_reader(cluster, dsm, *found).value_or(0);
  }
  return found;
}

}  // namespace manycore::matching
