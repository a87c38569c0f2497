// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "ndt/common/pose.hpp"
#include "ndt/map/voxel_map.hpp"

namespace manycore::ndt {

/// Writes the score of the best voxel for each of `count` points (x, y, z [m], sensor frame) at a
/// pose, or NaN for points without a voxel. The mean over points with a voxel is the nearest-voxel
/// likelihood. For visualization: runs point by point on the calling thread.
void point_scores(
  const MapView & map, double outlier_ratio, const Pose6 & pose, const float * xyz_m, size_t count,
  float * scores);

}  // namespace manycore::ndt
