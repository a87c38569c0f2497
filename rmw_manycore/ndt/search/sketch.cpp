// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "ndt/search/sketch.hpp"

#include <algorithm>
#include <cmath>

namespace manycore::ndt {
namespace {

/// After each of these many points the sum is compared with what is needed.
constexpr size_t stretch = 32;

/// Cell of a coordinate, seen from the middle of a cell.
int32_t cells_of(double from_middle_m) {
  const double cells = std::floor(from_middle_m / search_cell_m + 0.5);
  return static_cast<int32_t>(std::clamp<double>(cells, 1 - search_reach, search_reach - 1));
}

}  // namespace

Sketch::Sketch(const float * xyz_m, size_t count, uint32_t yaws, int32_t width)
: points_(count), rays_(count * yaws) {
  auto ray = rays_.begin();
  for (uint32_t yaw = 0; yaw < yaws; ++yaw) {
    const double c = std::cos(turn_rad * yaw / yaws);
    const double s = std::sin(turn_rad * yaw / yaws);
    for (size_t i = 0; i < count; ++i, ++ray) {
      const auto x = static_cast<double>(xyz_m[3 * i]);
      const auto y = static_cast<double>(xyz_m[3 * i + 1]);
      const auto z = static_cast<double>(xyz_m[3 * i + 2]);
      ray->column = cells_of(s * x + c * y) * width + cells_of(c * x - s * y);
      ray->height = static_cast<uint32_t>(static_cast<int32_t>(std::floor(z / search_cell_m)));
    }
  }
}

uint32_t points_at_something(
  const SearchMap & map, const Sketch & sketch, const Node & node, const Floor & floor,
  uint32_t needed) noexcept {
  const auto width = static_cast<uint32_t>(map.header().cells[0]);
  const uint64_t * const here = map.columns(node.level) + node.y * width + node.x;
  const uint64_t heights = floor.heights();
  const auto ground = static_cast<uint32_t>(static_cast<int32_t>(floor.low));
  const Ray * ray = sketch.rays(node.yaw);
  const size_t points = sketch.points();
  uint32_t found = 0;
  for (size_t begin = 0; begin < points; begin += stretch) {
    const size_t end = std::min(begin + stretch, points);
    for (size_t i = begin; i < end; ++i, ++ray) {
      const uint64_t column = here[ray->column];
      const uint32_t low = (ray->height + ground) % 64;
      const uint64_t above = column >> low | column << (63 - low) << 1;
      found += (above & heights) != 0;
    }
    const auto left = static_cast<uint32_t>(points - end);
    if (found + left < needed) {
      return found + left;
    }
  }
  return found;
}

}  // namespace manycore::ndt
