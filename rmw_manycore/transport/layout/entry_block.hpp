// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>

namespace manycore {

/// Continuation of a table in a cluster's SMEM; the entries follow it. Blocks of one table double
/// up to `largest_entry_block_bytes`: short tables stay small, and few blocks lead to any entry.
template<typename Entry>
struct alignas(sizeof(Entry)) EntryBlock {
  std::atomic<uint64_t> next;  ///< offset in the same segment; 0 = last

  Entry * entries() noexcept { return reinterpret_cast<Entry *>(this + 1); }
};

constexpr uint64_t largest_entry_block_bytes = 16 << 10;

/// Size of a table's block number `ordinal`, from 0. A whole number of granules, as SMEM is given
/// out in such.
constexpr uint64_t entry_block_bytes(uint32_t ordinal, uint64_t granule_bytes) {
  const uint64_t doubled = uint64_t{1024} << std::min(ordinal, 4u);
  return std::max(doubled, granule_bytes);
}
static_assert(entry_block_bytes(4, 1024) == largest_entry_block_bytes);
static_assert(entry_block_bytes(0, 4096) == 4096);

template<typename Entry>
constexpr uint32_t entries_of_block(uint32_t ordinal, uint64_t granule_bytes) {
  return static_cast<uint32_t>(entry_block_bytes(ordinal, granule_bytes) / sizeof(Entry)) - 1;
}

}  // namespace manycore
