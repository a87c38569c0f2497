// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace manycore::ndt {

using Cell = std::array<int32_t, 3>;

/// The box of cells that a map covers: what holds voxels, one cell of halo around it, and one of
/// border, so that a point outside can be clamped to a cell that is in no table.
struct Grid {
  static constexpr int32_t margin = 2;

  double voxel_size_m;
  std::array<double, 3> origin_m;  ///< a multiple of the voxel size, amid the points
  Cell first;                      ///< counted from the origin
  Cell cells;

  uint32_t key_of(const Cell & cell) const noexcept;
  /// The cell (counted from `first`) of a point in the map frame.
  Cell cell_of(const double * xyz_m) const noexcept;
};

/// The grid around points (x, y, z), all finite, at least one. Throws Error{invalid_argument} when
/// its cells do not fit 32-bit keys.
Grid grid_around(const std::vector<std::array<double, 3>> & points_m, double voxel_size_m);

}  // namespace manycore::ndt
