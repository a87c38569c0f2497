// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "ndt/common/options.hpp"
#include "ndt/map/grid.hpp"
#include "ndt/map/voxel_map.hpp"

namespace manycore::ndt {

/// For each cell with voxels in range, the lines of these voxels.
struct NeighbourLists {
  std::vector<TableSlot> cells;  ///< key and first list index of each cell
  std::vector<uint32_t> lists;   ///< the cell's own line first; each list ends with 0
};

/// A voxel and its cell.
struct PlacedVoxel {
  Cell cell;
  VoxelLine line;
};

/// `voxels` are in the order of their lines; the first one is line 1.
NeighbourLists neighbour_lists(
  const Grid & grid, const std::vector<PlacedVoxel> & voxels, Search search);

}  // namespace manycore::ndt
