// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "ndt/map/voxel_map.hpp"
#include "platform/shared_memory.hpp"

namespace manycore::ndt {

/// Levels of a search; nodes of level l are 2^l cells wide.
constexpr uint32_t search_levels = 5;
constexpr uint32_t root_level = search_levels - 1;
constexpr uint32_t root_cells = 1U << root_level;
/// Edge of a cell, and so the distance of the places that are compared.
constexpr double search_cell_m = 1;
/// Cells around the map, so that points of a scan need no bounds; farther ones are not used.
constexpr int32_t search_reach = 64;

/// Lowest and highest ground of a node, in cells; low > high where there is none.
struct Floor {
  int16_t low;
  int16_t high;

  bool is_known() const noexcept { return low <= high; }
  /// Bits of the heights that a point has above this ground, from the lowest one on.
  uint64_t heights() const noexcept {
    return ~uint64_t{0} >> (63 - (high - low > 63 ? 63 : high - low));
  }
};

/// Head of a search map in shared memory.
struct SearchMapHeader {
  static constexpr uint64_t magic_value = 0x68637261'65736d72;
  uint64_t magic;
  uint64_t id;            ///< of the voxel map
  int32_t first_cell[2];  ///< of column 0, in cells from the map frame's origin
  int32_t cells[2];       ///< size, with the reach on each side; what is inside is whole roots
  uint64_t columns_offset;
  uint64_t floors_offset[search_levels];
  uint64_t ground_offset;
  uint64_t size_bytes;
};
static_assert(std::is_trivially_copyable_v<SearchMapHeader>);

/// Where in the map something is, as columns of bits: bit z mod 64 of a column is set if there is
/// something in the z-th cell of height. A column of level l is the union of the 2^l by 2^l columns
/// from it on, so what a node's places see is in the node's column.
class SearchMap {
public:
  /// Takes memory filled by build_search_map(). Throws Error{corrupt} for any other memory.
  explicit SearchMap(SharedMemory memory);

  const SearchMapHeader & header() const noexcept { return memory_.at<const SearchMapHeader>(0); }
  const SharedMemory & memory() const noexcept { return memory_; }
  const uint64_t * columns(uint32_t level) const noexcept;
  /// Ground of the node of a level that begins at a column.
  Floor floor(uint32_t level, uint32_t x, uint32_t y) const noexcept;
  /// Coordinate [m, map frame] of the middle of some columns, from one on.
  double middle_m(size_t axis, uint32_t first, uint32_t columns) const noexcept;
  /// Height of the ground [m, map frame] of a column that has one.
  double ground_m(uint32_t x, uint32_t y) const noexcept;

private:
  SharedMemory memory_;
};

/// Bytes of the search map of a voxel map, before it is built; throws as build_search_map() does.
uint64_t search_map_bytes(const VoxelMap & map);

/// Builds the search map of a voxel map. Throws Error{invalid_argument} if it has more than 2^26
/// columns.
SearchMap build_search_map(const VoxelMap & map);

}  // namespace manycore::ndt
