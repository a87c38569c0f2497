// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/layout/topic_dsm_layout.hpp"

namespace manycore {

/// The newest message of a topic DSM. Record number and sequence number differ because some record
/// numbers are skipped.
struct LastPublished {
  uint64_t number;    ///< record number
  uint64_t sequence;  ///< publication sequence number
  /// False when the two may not belong together: the publisher is stopped between its stores.
  bool exact;
};

/// The publisher stores `skipped_before`, `last`, `skipped_after` in this order. The reader loads
/// them in the opposite order: if the two outer values are equal, `last` was stored with this
/// count. Bounded: never waits for a publisher that is stopped between its stores.
inline LastPublished last_published(const TopicDsmHeader & dsm) noexcept {
  constexpr int tries = 100;
  LastPublished published{};
  for (int i = 0; i < tries && !published.exact; ++i) {
    const uint64_t after = dsm.skipped_after.load(std::memory_order_seq_cst);
    published.number = dsm.last.load(std::memory_order_seq_cst);
    published.sequence = published.number - after;
    published.exact = dsm.skipped_before.load(std::memory_order_seq_cst) == after;
  }
  return published;
}

}  // namespace manycore
