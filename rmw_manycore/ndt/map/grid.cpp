// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "ndt/map/grid.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "ndt/map/voxel_map.hpp"
#include "platform/error.hpp"

namespace manycore::ndt {
namespace {

// The kernel counts cells in single precision, which is exact up to this limit.
constexpr double max_cells_per_axis = 1 << 22;

[[noreturn]] void refuse(double voxel_size_m) {
  throw Error(
    ErrorCode::invalid_argument,
    "the map spans more voxels of " + std::to_string(voxel_size_m) +
      " m than can be numbered; remove far-off points or choose a larger voxel_size_m");
}

}  // namespace

uint32_t Grid::key_of(const Cell & cell) const noexcept {
  const auto x = static_cast<uint32_t>(cell[0]);
  const auto y = static_cast<uint32_t>(cell[1]);
  const auto z = static_cast<uint32_t>(cell[2]);
  return x + static_cast<uint32_t>(cells[0]) * (y + static_cast<uint32_t>(cells[1]) * z);
}

Cell Grid::cell_of(const double * xyz_m) const noexcept {
  Cell cell;
  for (size_t i = 0; i < 3; ++i) {
    cell[i] = static_cast<int32_t>(std::floor((xyz_m[i] - origin_m[i]) / voxel_size_m)) - first[i];
  }
  return cell;
}

Grid grid_around(const std::vector<std::array<double, 3>> & points_m, double voxel_size_m) {
  Grid grid{voxel_size_m, {}, {}, {}};
  double cells = 1;
  for (size_t i = 0; i < 3; ++i) {
    const auto [low, high] = std::minmax_element(
      points_m.begin(), points_m.end(),
      [i](const auto & a, const auto & b) { return a[i] < b[i]; });
    const double first = std::floor((*low)[i] / voxel_size_m);
    const double last = std::floor((*high)[i] / voxel_size_m);
    const double count = last - first + 1 + 2 * Grid::margin;
    if (!(count < max_cells_per_axis)) {
      refuse(voxel_size_m);
    }
    const double middle = std::floor((first + last) / 2);
    grid.origin_m[i] = middle * voxel_size_m;
    grid.first[i] = static_cast<int32_t>(first - middle) - Grid::margin;
    grid.cells[i] = static_cast<int32_t>(count);
    cells *= count;
  }
  if (!(cells < empty_key)) {
    refuse(voxel_size_m);
  }
  return grid;
}

}  // namespace manycore::ndt
