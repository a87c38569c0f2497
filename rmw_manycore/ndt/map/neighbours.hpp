// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "ndt/common/options.hpp"
#include "ndt/map/grid.hpp"
#include "ndt/map/voxel_map.hpp"

namespace manycore::ndt {

/// For every cell from which a voxel can be seen, the lines of the voxels it sees.
struct NeighbourLists {
  std::vector<TableSlot> cells;  ///< key and first list index of each cell
  std::vector<uint32_t> lists;   ///< lines in rising order, each list ended by 0
};

/// A voxel and the cell it fills.
struct PlacedVoxel {
  Cell cell;
  VoxelLine line;
};

/// `voxels` in the order of their lines, of which the first is line 1.
NeighbourLists neighbour_lists(
  const Grid & grid, const std::vector<PlacedVoxel> & voxels, Search search);

}  // namespace manycore::ndt
