// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "platform/error.hpp"
#include "transport/layout/entry_block.hpp"
#include "transport/registry/cluster.hpp"

namespace manycore {

/// A chain of EntryBlocks in a cluster's SMEM: `first` is the link to its first block. A damaged
/// chain is not followed out of the cluster, nor round and round.
template<typename Entry>
class EntryChain {
public:
  using Block = EntryBlock<Entry>;
  static constexpr uint32_t entry_limit = 1u << 15;

  EntryChain(const Cluster & cluster, std::atomic<uint64_t> & first) noexcept
  : cluster_(cluster), first_(first) {}

  /// Calls `visit(Entry &, index)` for each entry from `from` on, used or not, until it returns
  /// true.
  template<typename Visit>
  void visit(uint32_t from, Visit visit) const {
    for_each_block([&](Block & block, uint32_t first_index, uint32_t count) {
      for (uint32_t i = from > first_index ? from - first_index : 0; i < count; ++i) {
        if (visit(block.entries()[i], first_index + i)) {
          return true;
        }
      }
      return false;
    });
  }

  /// Nullptr where the chain is shorter.
  Entry * find(uint32_t index) const noexcept {
    Entry * found = nullptr;
    for_each_block([&](Block & block, uint32_t first_index, uint32_t count) {
      if (index - first_index < count) {
        found = block.entries() + (index - first_index);
      }
      return found != nullptr;
    });
    return found;
  }

  std::optional<uint32_t> index_of(const Entry & entry) const noexcept {
    std::optional<uint32_t> found;
    for_each_block([&](Block & block, uint32_t first_index, uint32_t count) {
      if (&entry >= block.entries() && &entry < block.entries() + count) {
        found = first_index + static_cast<uint32_t>(&entry - block.entries());
      }
      return found.has_value();
    });
    return found;
  }

  /// Calls `visit(offset, bytes)` for each block; it may be freed thereby.
  template<typename Visit>
  void visit_memory(Visit visit) const {
    uint64_t next = first_.load();
    for (uint32_t ordinal = 0; next != 0 && ordinal < entry_limit; ++ordinal) {
      const uint64_t offset = next;
      const uint64_t bytes = entry_block_bytes(ordinal, cluster_.granule_bytes());
      const auto * const block = cluster_.find<Block>(offset, bytes);
      if (block == nullptr) {
        return;
      }
      next = block->next.load();
      visit(offset, bytes);
    }
  }

  /// Adds a block of cleared entries; the caller holds the registry lock. `cluster` is the chain's.
  /// Returns the first of them. Throws Error{no_space|corrupt}.
  Entry & grow(Cluster & cluster) {
    std::atomic<uint64_t> * end = &first_;
    uint32_t ordinal = 0;
    for_each_block([&](Block & block, uint32_t, uint32_t) {
      end = &block.next;
      ++ordinal;
      return false;
    });
    if (end->load() != 0) {
      throw Error(
        ErrorCode::corrupt, "cluster " + std::to_string(cluster.id()) +
                              " is damaged; stop the platform's nodes and run 'manycore clean'");
    }
    auto & block =
      cluster.allocate_cleared<Block>(entry_block_bytes(ordinal, cluster.granule_bytes()));
    end->store(cluster.ref_of(&block).offset(), std::memory_order_release);
    return block.entries()[0];
  }

private:
  /// Calls `visit(Block &, index of its first entry, entries)` until it returns true.
  template<typename Visit>
  void for_each_block(Visit visit) const {
    uint64_t next = first_.load(std::memory_order_acquire);
    uint32_t index = 0;
    for (uint32_t ordinal = 0; next != 0 && index < entry_limit; ++ordinal) {
      const uint64_t bytes = entry_block_bytes(ordinal, cluster_.granule_bytes());
      auto * const block = cluster_.find<Block>(next, bytes);
      if (block == nullptr) {
        return;
      }
      const uint32_t count = entries_of_block<Entry>(ordinal, cluster_.granule_bytes());
      if (visit(*block, index, count)) {
        return;
      }
      index += count;
      next = block->next.load(std::memory_order_acquire);
    }
  }

  const Cluster & cluster_;
  std::atomic<uint64_t> & first_;
};

}  // namespace manycore
