// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "ndt/scan.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace manycore::ndt {
namespace {

constexpr float far_away_m = 1e9F;

/// Spreads the low 10 bits of x so that two zeros follow each.
uint32_t spread(uint32_t x) {
  x = (x | (x << 16)) & 0x030000FF;
  x = (x | (x << 8)) & 0x0300F00F;
  x = (x | (x << 4)) & 0x030C30C3;
  return (x | (x << 2)) & 0x09249249;
}

/// Place on the Morton curve through cubes of 0.5 m, modulo 512 m.
uint32_t morton_code(const float * xyz_m) {
  constexpr float cubes_per_m = 2;
  uint32_t code = 0;
  for (uint32_t i = 0; i < 3; ++i) {
    const float cube = std::clamp(std::floor(xyz_m[i] * cubes_per_m) + 512, 0.0F, 1023.0F);
    code |= spread(static_cast<uint32_t>(cube)) << i;
  }
  return code;
}

using Place = std::pair<uint32_t, uint32_t>;  // Morton code, index

/// Sorts by code, stably, in three rounds of 10 bits.
void radix_sort(std::vector<Place> & places) {
  std::vector<Place> other(places.size());
  for (uint32_t shift = 0; shift < 30; shift += 10) {
    std::vector<uint32_t> begin(1025);
    for (const Place & place : places) {
      ++begin[((place.first >> shift) & 1023) + 1];
    }
    for (size_t i = 1; i < begin.size(); ++i) {
      begin[i] += begin[i - 1];
    }
    for (const Place & place : places) {
      other[begin[(place.first >> shift) & 1023]++] = place;
    }
    places.swap(other);
  }
}

}  // namespace

ScanView lay_out_scan(const float * xyz_m, size_t count, float * floats) {
  std::vector<Place> places;
  places.reserve(count);
  for (size_t i = 0; i < count; ++i) {
    const float * const point = xyz_m + 3 * i;
    if (std::isfinite(point[0]) && std::isfinite(point[1]) && std::isfinite(point[2])) {
      places.emplace_back(morton_code(point), static_cast<uint32_t>(i));
    }
  }
  radix_sort(places);

  const ScanView scan = view_scan(floats, places.size());
  const size_t stride = scan.groups * group_points;
  for (size_t i = 0; i < stride; ++i) {
    for (size_t axis = 0; axis < 3; ++axis) {
      floats[axis * stride + i] =
        i < places.size() ? xyz_m[3 * size_t{places[i].second} + axis] : far_away_m;
    }
  }
  return scan;
}

ScanView view_scan(const float * floats, size_t points) {
  const size_t groups = (points + group_points - 1) / group_points;
  const size_t stride = groups * group_points;
  return {floats, floats + stride, floats + 2 * stride, points, groups};
}

}  // namespace manycore::ndt
