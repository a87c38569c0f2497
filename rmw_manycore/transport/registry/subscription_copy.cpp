// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/registry/subscription_copy.hpp"

namespace manycore {

/// The words of a copy may be of different moments. Once two copies in turn agree on how far the
/// queue has moved, the second one is of one moment. If pops do not cease, `head` is of the copy
/// before: displaced() then counts too few rather than too many.
bool SubscriptionCopy::take(const Cluster & cluster, uint64_t offset) noexcept {
  constexpr int max_copies = 16;
  uint64_t head = 0;
  uint64_t pops = 0;
  for (int copies = 1; copies <= max_copies; ++copies) {
    if (!cluster.copy_out(offset, bytes_, sizeof bytes_)) {
      return false;
    }
    const uint64_t moved_to = header().head.load(std::memory_order_relaxed);
    const uint64_t begun = header().pops_begun.load(std::memory_order_relaxed);
    const bool is_popping = begun != header().pops_done.load(std::memory_order_relaxed);
    if (copies > 1 && moved_to == head && begun == pops && !is_popping) {
      return true;
    }
    header().head.store(copies > 1 ? head : moved_to, std::memory_order_relaxed);
    head = moved_to;
    pops = begun;
  }
  return true;
}

}  // namespace manycore
