// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/layout/topic_dsm_layout.hpp"
#include "transport/registry/cluster.hpp"

namespace manycore {

/// Calls `visit(ReaderEntry &)` for each entry of a topic DSM's reader table, used or not, until it
/// returns true. Bounded: a damaged chain ends.
template<typename Visit>
void visit_reader_table(const Cluster & cluster, TopicDsmHeader & dsm, Visit visit) {
  for (ReaderEntry & entry : dsm.readers) {
    if (visit(entry)) {
      return;
    }
  }
  uint64_t next = dsm.next_reader_block.load(std::memory_order_acquire);
  for (uint32_t i = 0; next != 0 && i < 1024; ++i) {
    auto * const block = cluster.find<ReaderBlock>(next);
    if (block == nullptr) {
      return;
    }
    for (ReaderEntry & entry : block->entries) {
      if (visit(entry)) {
        return;
      }
    }
    next = block->next.load(std::memory_order_acquire);
  }
}

/// As visit_reader_table, active entries only, no early end.
template<typename Visit>
void for_each_reader(const Cluster & cluster, TopicDsmHeader & dsm, Visit visit) {
  visit_reader_table(cluster, dsm, [&](ReaderEntry & entry) {
    if (entry.active.load(std::memory_order_acquire) != 0) {
      visit(entry);
    }
    return false;
  });
}

}  // namespace manycore
