// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>

namespace manycore {

constexpr uint32_t max_entry_blocks = 11;

/// Blocks of a table in a cluster's SMEM. Each block is twice the size of its predecessor: short
/// tables stay small, and the block of an index is computed, not searched.
struct EntryBlocks {
  /// Offsets in the same segment; 0 = not allocated. Written under the registry lock.
  std::atomic<uint64_t> offsets[max_entry_blocks];
};

/// Size of block `block`, counted from 0. A whole number of granules, the unit of SMEM allocation.
constexpr uint64_t entry_block_bytes(uint32_t block, uint64_t granule_bytes) {
  return granule_bytes << block;
}

}  // namespace manycore
