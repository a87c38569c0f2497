// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "transport/layout/subscription_layout.hpp"
#include "transport/layout/topic_dsm_layout.hpp"
#include "transport/registry/block_in_hand.hpp"
#include "transport/registry/cluster.hpp"
#include "transport/registry/entry_table.hpp"

namespace manycore::matching {

/// Finds the entries of a new match. A table that is full gets another block: a small one at once,
/// a large one from the hand, which the caller has to make first. The caller holds the registry
/// lock. Throws Error{no_space|corrupt}.
class FreeEntries {
public:
  /// `hand`: nullptr = empty.
  explicit FreeEntries(BlockInHand * hand) noexcept : hand_(hand) {}

  struct Source {
    SourceEntry * entry;
    uint32_t index;
  };
  /// Without an entry if a block is needed(). `cluster`: that of the subscription.
  Source source(Cluster & cluster, SubscriptionHeader & subscription);
  /// Nullptr if a block is needed(). `cluster`: that of the topic DSM.
  ReaderEntry * reader(Cluster & cluster, TopicDsmHeader & dsm);
  const std::optional<NeededBlock> & needed() const noexcept { return needed_; }

private:
  template<typename Entry>
  Entry * grow(const EntryTable<Entry> & table, Cluster & cluster);

  BlockInHand * const hand_;
  std::optional<NeededBlock> needed_;
};

}  // namespace manycore::matching
