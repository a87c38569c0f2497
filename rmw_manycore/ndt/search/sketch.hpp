// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "ndt/search/search_map.hpp"

namespace manycore::ndt {

inline constexpr double turn_rad = 6.283185307179586;

/// A cell of a scan, as seen from the column that the sensor is in.
struct Ray {
  int32_t column;   ///< distance of the columns' indices
  uint32_t height;  ///< cells above the ground, modulo 64
};

/// Some points of a scan, turned to each of the directions that are compared.
class Sketch {
public:
  /// @param xyz_m x, y of level points from the sensor on, and z above the ground [m].
  /// @param yaws number of directions, from 0 on.
  /// @param width of the search map, in columns.
  Sketch(const float * xyz_m, size_t count, uint32_t yaws, int32_t width);

  size_t points() const noexcept { return points_; }
  const Ray * rays(uint32_t yaw) const noexcept { return rays_.data() + yaw * points_; }

private:
  size_t points_;
  std::vector<Ray> rays_;
};

/// A square of places, 2^level columns wide, and a direction.
struct Node {
  uint32_t level;
  uint32_t x;  ///< first column
  uint32_t y;
  uint32_t yaw;
};

/// Number of points that are at something in the map, from the place of the node from which they
/// are most; at level 0 from its only place, above that an upper bound. Below `needed` a larger
/// number than that of any place may be returned early.
uint32_t points_at_something(
  const SearchMap & map, const Sketch & sketch, const Node & node, const Floor & floor,
  uint32_t needed) noexcept;

}  // namespace manycore::ndt
