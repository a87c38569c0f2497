// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/cluster.hpp"
#include "transport/subscription_layout.hpp"

namespace manycore {

/// Calls `visit(SourceEntry &, index)` for each entry of a subscription's source table, used or not, until
/// it returns true. Bounded: a damaged chain ends.
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

}  // namespace manycore
