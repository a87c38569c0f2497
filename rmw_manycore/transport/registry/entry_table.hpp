// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "platform/error.hpp"
#include "transport/layout/entry_blocks.hpp"
#include "transport/registry/cluster.hpp"

namespace manycore {

/// A table of entries in a cluster's SMEM, located through its EntryBlocks. Damaged offsets never
/// lead out of the cluster.
template<typename Entry>
class EntryTable {
public:
  EntryTable(const Cluster & cluster, EntryBlocks & blocks) noexcept
  : cluster_(cluster), blocks_(blocks) {}

  /// Calls `visit(Entry &)` for each entry, used or free, until it returns true.
  template<typename Visit>
  void visit(Visit visit) const {
    for (uint32_t block = 0; block < max_entry_blocks; ++block) {
      Entry * const entries = entries_of(block);
      if (entries == nullptr) {
        return;
      }
      for (uint32_t i = 0; i < capacity(block); ++i) {
        if (visit(entries[i])) {
          return;
        }
      }
    }
  }

  struct Block {
    uint64_t offset;
    uint64_t bytes;
  };
  std::optional<Block> last() const noexcept {
    const uint32_t count = block_count();
    return count == 0
             ? std::nullopt
             : std::optional(Block{blocks_.offsets[count - 1].load(), bytes_of(count - 1)});
  }
  /// Takes the last block off the table. The caller holds the registry lock.
  void drop_last() const noexcept { blocks_.offsets[block_count() - 1].store(0); }

  /// Calls `visit(offset, bytes)` for each block.
  template<typename Visit>
  void visit_memory(Visit visit) const {
    for (uint32_t block = 0; block < max_entry_blocks && entries_of(block) != nullptr; ++block) {
      visit(blocks_.offsets[block].load(), bytes_of(block));
    }
  }

  /// Size of the block with which the table would grow. The caller holds the registry lock. Throws
  /// Error{corrupt}.
  uint64_t next_block_bytes() const { return bytes_of(next_block()); }

  /// Adds a block of that size, of cleared entries, at an offset in the table's cluster. Returns
  /// its first entry. The caller holds the registry lock. Throws Error{corrupt}.
  Entry & grow(uint64_t offset) const {
    const uint32_t block = next_block();
    auto * const first = cluster_.find<Entry>(offset, bytes_of(block));
    if (first == nullptr) {
      throw damaged();
    }
    blocks_.offsets[block].store(offset, std::memory_order_release);
    return *first;
  }

private:
  Error damaged() const {
    return Error(
      ErrorCode::corrupt, "cluster " + std::to_string(cluster_.id()) +
                            " is damaged; stop the platform's nodes and run 'manycore clean'");
  }
  uint32_t block_count() const noexcept {
    uint32_t count = 0;
    while (count < max_entry_blocks && entries_of(count) != nullptr) {
      ++count;
    }
    return count;
  }
  uint32_t next_block() const {
    const uint32_t block = block_count();
    if (block == max_entry_blocks || blocks_.offsets[block].load() != 0) {
      throw damaged();
    }
    return block;
  }
  uint64_t bytes_of(uint32_t block) const noexcept {
    return entry_block_bytes(block, cluster_.granule_bytes());
  }
  uint32_t capacity(uint32_t block) const noexcept {
    return static_cast<uint32_t>(bytes_of(block) / sizeof(Entry));
  }
  /// Nullptr if the block is not allocated.
  Entry * entries_of(uint32_t block) const noexcept {
    const uint64_t offset = blocks_.offsets[block].load(std::memory_order_acquire);
    return offset == 0 ? nullptr : cluster_.find<Entry>(offset, bytes_of(block));
  }

  const Cluster & cluster_;
  EntryBlocks & blocks_;
};

}  // namespace manycore
