// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "ndt/kernel/point_scores.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ndt/kernel/derivatives.hpp"
#include "ndt/kernel/pass.hpp"
#include "ndt/map/table.hpp"

namespace manycore::ndt {
namespace {

/// x'Bx of eq. 6.9; infinity if the voxel is out of the search range.
double distance(const MapHeader & map, const VoxelLine & line, const float (&place_m)[3]) {
  double x[3];
  for (size_t i = 0; i < 3; ++i) {
    x[i] = static_cast<double>(place_m[i]) - static_cast<double>(line.mean_m[i]);
  }
  const double squared_m = x[0] * x[0] + x[1] * x[1] + x[2] * x[2];
  if (map.search == Search::radius && squared_m > map.voxel_size_m * map.voxel_size_m) {
    return std::numeric_limits<double>::infinity();
  }
  const float * const b = line.inverse_covariance;
  return b[0] * x[0] * x[0] + b[3] * x[1] * x[1] + b[5] * x[2] * x[2] +
         2 * (b[1] * x[0] * x[1] + b[2] * x[0] * x[2] + b[4] * x[1] * x[2]);
}

}  // namespace

void point_scores(
  const MapView & map, double outlier_ratio, const Pose6 & pose, const float * xyz_m, size_t count,
  float * scores) {
  const Gaussian constants = gaussian(outlier_ratio, map.header->voxel_size_m);
  const PassPose at = pass_pose(pose, *map.header);
  for (size_t point = 0; point < count; ++point) {
    const float * const p = xyz_m + 3 * point;
    scores[point] = std::numeric_limits<float>::quiet_NaN();
    if (!(std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]))) {
      continue;
    }
    float place_m[3];
    for (size_t i = 0; i < 3; ++i) {
      const float * const row = at.rotation + 3 * i;
      place_m[i] = row[0] * p[0] + row[1] * p[1] + row[2] * p[2] + at.translation_m[i];
    }
    double nearest = std::numeric_limits<double>::infinity();
    for (const uint32_t * line = voxels_at(map, place_m); *line != 0; ++line) {
      nearest = std::min(nearest, distance(*map.header, map.lines[*line], place_m));
    }
    if (std::isfinite(nearest)) {
      scores[point] = static_cast<float>(-constants.d1 * std::exp(-constants.d2 / 2 * nearest));
    }
  }
}

}  // namespace manycore::ndt
