// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>

namespace manycore {

/// Set of slots of a table, one bit each.
template<uint32_t capacity>
struct SlotSet {
  static constexpr uint32_t slots_per_part = 64;
  static_assert(capacity % slots_per_part == 0);

  std::atomic<uint64_t> parts[capacity / slots_per_part];

  /// Costs one load if the slot is in the set already.
  void add(uint32_t slot) noexcept {
    std::atomic<uint64_t> & part = parts[slot / slots_per_part];
    if ((part.load(std::memory_order_seq_cst) & bit(slot)) == 0) {
      part.fetch_or(bit(slot), std::memory_order_seq_cst);
    }
  }
  void remove(uint32_t slot) noexcept {
    parts[slot / slots_per_part].fetch_and(~bit(slot), std::memory_order_seq_cst);
  }
  bool contains(uint32_t slot) const noexcept {
    return (parts[slot / slots_per_part].load(std::memory_order_seq_cst) & bit(slot)) != 0;
  }
  template<typename Visit>
  void for_each(Visit visit) const {
    for (uint32_t begin = 0; begin < capacity; begin += slots_per_part) {
      const uint64_t part = parts[begin / slots_per_part].load(std::memory_order_seq_cst);
      for (uint64_t left = part; left != 0; left &= left - 1) {
        visit(begin + static_cast<uint32_t>(__builtin_ctzll(left)));
      }
    }
  }

  void clear() noexcept {
    for (std::atomic<uint64_t> & part : parts) {
      part.store(0, std::memory_order_seq_cst);
    }
  }

private:
  static constexpr uint64_t bit(uint32_t slot) noexcept {
    return uint64_t{1} << slot % slots_per_part;
  }
};

}  // namespace manycore
