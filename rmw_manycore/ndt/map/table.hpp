// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "ndt/map/voxel_map.hpp"

namespace manycore::ndt {

/// Multiplicative hashing: neighbouring keys land far apart, so clusters of them do not build up.
inline uint32_t first_slot(uint32_t key, uint32_t shift) noexcept {
  return (key * 2654435769u) >> shift;
}

/// The list index of a cell, empty_list for one that sees no voxel.
inline uint32_t find_list(const MapView & map, uint32_t key) noexcept {
  const uint32_t shift = map.header->table_shift;
  const uint32_t mask = 0xFFFFFFFFu >> shift;
  for (uint32_t slot = first_slot(key, shift);; slot = (slot + 1) & mask) {
    const TableSlot & entry = map.table[slot];
    if (entry.key == key) {
      return entry.list_index;
    }
    if (entry.key == empty_key) {
      return empty_list;
    }
  }
}

}  // namespace manycore::ndt
