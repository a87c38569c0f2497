// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "ndt/common/pose.hpp"
#include "ndt/map/voxel_map.hpp"

namespace manycore::ndt {

/// Writes for each of count points (x, y, z [m], sensor frame) at a pose the score of the voxel it
/// fits best, NaN where it sees none. Their mean over points that see a voxel is the likelihood of
/// the nearest voxels. For pictures: one point after the other, on the calling thread.
void point_scores(
  const MapView & map, double outlier_ratio, const Pose6 & pose, const float * xyz_m, size_t count,
  float * scores);

}  // namespace manycore::ndt
