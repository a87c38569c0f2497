// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/layout/topic_dsm_layout.hpp"

namespace manycore {

/// The newest message of a topic DSM. Some record numbers are skipped, so the two differ.
struct LastPublished {
  uint64_t number;    ///< of its record
  uint64_t sequence;  ///< how many messages the publisher has published with it
  bool exact;  ///< false when the publisher stands still at a moment where the two may not fit
               ///< together
};

/// The publisher stores `skipped_before`, `last`, `skipped_after` in this order. Read the other way
/// round, equal outer values mean that `last` was stored under this count. Never waits for a
/// publisher that was stopped in between.
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
