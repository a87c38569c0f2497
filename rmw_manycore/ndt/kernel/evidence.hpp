// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "ndt/common/pose.hpp"
#include "ndt/map/voxel_map.hpp"

namespace manycore::ndt {

/// Evidence of a map about one point of a scan.
struct PointEvidence {
  float score;           ///< of the best voxel in range; NaN without one
  float height_m;        ///< above the floor of the point's column; NaN where that is empty
  float columns_around;  ///< columns with voxels among the eight around it
  float is_past_map;     ///< 1 if the ray to the point passes through a mapped surface
};
static_assert(sizeof(PointEvidence) == 4 * sizeof(float));

/// Writes the evidence for `count` points (x, y, z [m], sensor frame) at a pose. Runs point by
/// point on the calling thread: pass a sample of a scan.
void point_evidence(
  const MapView & map, double outlier_ratio, const Pose6 & pose, const float * xyz_m, size_t count,
  PointEvidence * evidence);

/// Writes for `count` points (x, y, z [m], sensor frame) at a pose how many of the eight columns
/// around theirs have voxels; 0 where the point's own has none. Runs on the calling thread.
void columns_around(
  const MapView & map, const Pose6 & pose, const float * xyz_m, size_t count, uint8_t * around);

}  // namespace manycore::ndt
