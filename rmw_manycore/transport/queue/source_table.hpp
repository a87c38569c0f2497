// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/queue/displaced.hpp"
#include "transport/queue/subscriber_queue.hpp"
#include "transport/registry/entry_table.hpp"

namespace manycore {

/// The source table of a subscription.
inline EntryTable<SourceEntry> source_table(
  const Cluster & cluster, SubscriptionHeader & subscription) noexcept {
  return {cluster, subscription.sources};
}

/// Calls `visit(SourceEntry &, index)` for each entry of the source table, used or free, until it
/// returns true.
template<typename Visit>
void visit_source_table(const Cluster & cluster, SubscriptionHeader & subscription, Visit visit) {
  source_table(cluster, subscription).visit(0, visit);
}

/// Records in the source's entry that a hint was displaced, so that the subscriber does not wait
/// for it.
inline void note_displaced(SourceEntry & source, const Hint & hint) noexcept {
  if (hint.is_of(source.incarnation.load(std::memory_order_relaxed))) {
    Displaced::raise(source.displaced, hint);
  }
}
inline void note_displaced(
  const Cluster & cluster, SubscriptionHeader & subscription, const Hint & hint) noexcept {
  if (auto * const source = source_table(cluster, subscription).find(hint.source)) {
    note_displaced(*source, hint);
  }
}

}  // namespace manycore
