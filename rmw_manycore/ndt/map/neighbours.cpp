// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "ndt/map/neighbours.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace manycore::ndt {
namespace {

/// Sorts the voxels around a cell behind the one in it.
constexpr uint32_t behind_own = 1U << 31;

std::vector<Cell> offsets_of(Search search) {
  std::vector<Cell> offsets;
  for (int32_t z = -1; z <= 1; ++z) {
    for (int32_t y = -1; y <= 1; ++y) {
      for (int32_t x = -1; x <= 1; ++x) {
        const int32_t faces = std::abs(x) + std::abs(y) + std::abs(z);
        if (search == Search::radius || faces == 0 || (search == Search::direct7 && faces == 1)) {
          offsets.push_back({x, y, z});
        }
      }
    }
  }
  return offsets;
}

/// True if a point of the cell may be within one voxel size of the voxel's mean.
bool is_in_reach(const Grid & grid, const PlacedVoxel & voxel, const Cell & cell) {
  double squared_m2 = 0;
  for (size_t i = 0; i < 3; ++i) {
    const double low_m = (cell[i] + grid.first[i]) * grid.voxel_size_m;
    const double mean_m = voxel.line.mean_m[i];
    const double beyond_m = std::max({low_m - mean_m, mean_m - (low_m + grid.voxel_size_m), 0.0});
    squared_m2 += beyond_m * beyond_m;
  }
  constexpr double rounding = 1.001;
  return squared_m2 <= grid.voxel_size_m * grid.voxel_size_m * rounding;
}

}  // namespace

NeighbourLists neighbour_lists(
  const Grid & grid, const std::vector<PlacedVoxel> & voxels, Search search) {
  std::vector<std::pair<uint32_t, uint32_t>> seen;  // cell key, line
  const std::vector<Cell> offsets = offsets_of(search);
  for (size_t i = 0; i < voxels.size(); ++i) {
    for (const Cell & offset : offsets) {
      Cell cell = voxels[i].cell;
      for (size_t axis = 0; axis < 3; ++axis) {
        cell[axis] += offset[axis];
      }
      if (search != Search::radius || is_in_reach(grid, voxels[i], cell)) {
        const uint32_t order = cell == voxels[i].cell ? 0 : behind_own;
        seen.emplace_back(grid.key_of(cell), order | static_cast<uint32_t>(i + 1));
      }
    }
  }
  std::sort(seen.begin(), seen.end());

  NeighbourLists out;
  out.lists.push_back(0);  // list of cells without voxels
  for (const auto & [key, line] : seen) {
    if (out.cells.empty() || out.cells.back().key != key) {
      if (!out.cells.empty()) {
        out.lists.push_back(0);
      }
      out.cells.push_back({key, static_cast<uint32_t>(out.lists.size())});
    }
    out.lists.push_back(line & ~behind_own);
  }
  out.lists.push_back(0);
  return out;
}

}  // namespace manycore::ndt
