// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>

namespace manycore {

constexpr uint32_t max_entry_blocks = 11;

/// The blocks of a table in a cluster's SMEM. Each is twice as large as the one before: short
/// tables stay small, and an index leads straight to its entry.
struct EntryBlocks {
  /// In the same segment; 0 = not there yet. Added under the registry lock.
  std::atomic<uint64_t> offsets[max_entry_blocks];
};

/// Size of block number `block`, from 0: whole granules, as SMEM is given out in such.
constexpr uint64_t entry_block_bytes(uint32_t block, uint64_t granule_bytes) {
  return granule_bytes << block;
}

}  // namespace manycore
