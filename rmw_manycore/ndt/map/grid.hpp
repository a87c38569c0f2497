// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace manycore::ndt {

using Cell = std::array<int32_t, 3>;

/// Bounding box of a map in cells: cells with voxels, one cell of halo around them, and one cell of
/// border, so that points outside can be clamped to a cell that is in no table.
struct Grid {
  static constexpr int32_t margin = 2;

  double voxel_size_m;
  std::array<double, 3> origin_m;  ///< a multiple of the voxel size, near the centre of the points
  Cell first;                      ///< relative to the origin
  Cell cells;

  uint32_t key_of(const Cell & cell) const noexcept;
  /// Cell of a point in the map frame, relative to `first`.
  Cell cell_of(const double * xyz_m) const noexcept;
};

/// Grid around points (x, y, z [m]), all finite, at least one. Throws Error{invalid_argument} if
/// the cells exceed 32-bit keys.
Grid grid_around(const std::vector<std::array<double, 3>> & points_m, double voxel_size_m);

}  // namespace manycore::ndt
