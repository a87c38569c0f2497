// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/queue/displaced.hpp"
#include "transport/queue/subscriber_queue.hpp"
#include "transport/registry/cluster.hpp"

namespace manycore {

/// Calls `visit(SourceEntry &, index)` for each entry of a subscription's source table, used or
/// not, until it returns true. Bounded: a damaged chain ends.
template<typename Visit>
void visit_source_table(const Cluster & cluster, SubscriptionHeader & subscription, Visit visit) {
  uint64_t next = subscription.first_source_block.load(std::memory_order_acquire);
  for (uint32_t index = 0; next != 0 && index < (1u << 14);) {
    auto * const block = cluster.find<SourceBlock>(next);
    if (block == nullptr) {
      return;
    }
    for (SourceEntry & entry : block->entries) {
      if (visit(entry, index++)) {
        return;
      }
    }
    next = block->next.load(std::memory_order_acquire);
  }
}

/// Notes in its source's entry that a hint was displaced, for the subscriber to know that it is not
/// on its way.
inline void note_displaced(
  const Cluster & cluster, SubscriptionHeader & subscription, const Hint & hint) noexcept {
  visit_source_table(cluster, subscription, [&](SourceEntry & source, uint32_t index) {
    if (index != hint.source) {
      return false;
    }
    const uint32_t incarnation = source.incarnation.load(std::memory_order_relaxed);
    if ((incarnation & Hint::incarnation_mask) == hint.source_incarnation) {
      Displaced::raise(source.displaced, hint);
    }
    return true;
  });
}

}  // namespace manycore
