// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "ndt/map/voxel_map.hpp"

namespace manycore::ndt {

/// Multiplicative hashing, which scatters neighbouring keys and so avoids clustering.
inline uint32_t first_slot(uint32_t key, uint32_t shift) noexcept {
  return (key * 2654435769u) >> shift;
}

/// List index of a cell; empty_list for a cell without voxels in range.
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

/// Voxel list of a position relative to the map's origin. Positions outside the grid are clamped to
/// its border, whose list is empty.
inline const uint32_t * voxels_at(const MapView & map, const float (&place_m)[3]) noexcept {
  const MapHeader & header = *map.header;
  uint32_t cell[3];
  for (size_t i = 0; i < 3; ++i) {
    const double from_first =
      static_cast<double>(place_m[i]) / header.voxel_size_m - header.first_cell[i];
    cell[i] = static_cast<uint32_t>(std::clamp<double>(from_first, 0, header.cells[i] - 1));
  }
  const auto width = static_cast<uint32_t>(header.cells[0]);
  const auto depth = static_cast<uint32_t>(header.cells[1]);
  return map.lists + find_list(map, cell[0] + (cell[1] + cell[2] * depth) * width);
}

}  // namespace manycore::ndt
