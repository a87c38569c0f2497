// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "ndt/kernel/scan.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace manycore::ndt {
namespace {

constexpr float far_away_m = 1e9F;
/// Cubes of the size of a typical voxel. Beyond 64 m their codes repeat, which degrades the order
/// only.
constexpr float cube_m = 2;
constexpr uint32_t cubes_per_axis_bits = 5;
constexpr uint32_t cube_count = 1 << (3 * cubes_per_axis_bits);
constexpr uint16_t no_cube = 0xFFFF;

/// Inserts two zero bits after each of the low 5 bits of x.
constexpr uint32_t spread(uint32_t x) {
  uint32_t out = 0;
  for (uint32_t bit = 0; bit < cubes_per_axis_bits; ++bit) {
    out |= ((x >> bit) & 1) << (3 * bit);
  }
  return out;
}

struct SpreadTable {
  std::array<uint16_t, 1 << cubes_per_axis_bits> of{};
  constexpr SpreadTable() {
    for (uint32_t i = 0; i < of.size(); ++i) {
      of[i] = static_cast<uint16_t>(spread(i));
    }
  }
};
constexpr SpreadTable spread_table;

/// Morton code of a point's cube; no_cube for a point that is ignored.
uint16_t cube_of(const float * xyz_m) {
  constexpr float farthest_m = 1e6F;
  uint32_t code = 0;
  for (uint32_t i = 0; i < 3; ++i) {
    if (!(std::abs(xyz_m[i]) <= far_away_m)) {  // also false for NaN
      return no_cube;
    }
    const float place_m = std::clamp(xyz_m[i], -farthest_m, farthest_m) + farthest_m;
    const auto cube = static_cast<uint32_t>(place_m * (1 / cube_m));
    code |= static_cast<uint32_t>(spread_table.of[cube % spread_table.of.size()]) << i;
  }
  return static_cast<uint16_t>(code);
}

}  // namespace

ScanView lay_out_scan(const float * xyz_m, size_t count, float * floats) {
  std::vector<uint16_t> cubes(count);
  std::vector<uint32_t> next(cube_count + 1);  // index of the next point of each cube
  for (size_t i = 0; i < count; ++i) {
    cubes[i] = cube_of(xyz_m + 3 * i);
    next[cubes[i] == no_cube ? cube_count : cubes[i]]++;
  }
  uint32_t points = 0;
  for (uint32_t cube = 0; cube < cube_count; ++cube) {
    points += std::exchange(next[cube], points);
  }
  const ScanView scan = view_scan(floats, points);
  const size_t stride = scan.groups * group_points;
  for (size_t i = 0; i < count; ++i) {
    if (cubes[i] != no_cube) {
      const uint32_t place = next[cubes[i]]++;
      for (size_t axis = 0; axis < 3; ++axis) {
        floats[axis * stride + place] = xyz_m[3 * i + axis];
      }
    }
  }
  for (size_t axis = 0; axis < 3; ++axis) {
    std::fill(floats + axis * stride + points, floats + (axis + 1) * stride, far_away_m);
  }
  return scan;
}

ScanView view_scan(const float * floats, size_t points) {
  const size_t groups = (points + group_points - 1) / group_points;
  const size_t stride = groups * group_points;
  return {floats, floats + stride, floats + 2 * stride, points, groups, groups};
}

ScanView thinned(const ScanView & scan, size_t points) {
  ScanView out = scan;
  if (scan.points >= 2 * points) {
    out.used = points / group_points;
    out.stride = scan.groups * ScanView::one / out.used;
    out.points = out.used * group_points;  // the last group, which is padded, is not used
  }
  return out;
}

}  // namespace manycore::ndt
