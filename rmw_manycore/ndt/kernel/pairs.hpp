// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "ndt/common/pose.hpp"
#include "ndt/kernel/tangent_sums.hpp"
#include "ndt/map/voxel_map.hpp"

namespace manycore::ndt {

/// A point and a voxel in its range, with all that the derivatives need of both. Search and sums
/// can so run in different clusters, of which only the first has the map.
struct Pair {
  float q_m[3];                 ///< the point, rotated into the map frame
  float x_m[3];                 ///< from the voxel's mean to the point
  float inverse_covariance[6];  ///< xx, xy, xz, yy, yz, zz
};
static_assert(sizeof(Pair) == 12 * sizeof(float));

/// The pairs of some points, point by point.
struct Pairs {
  std::vector<uint8_t> counts;  ///< pairs of each point
  std::vector<Pair> pairs;
};

/// Searches the voxels in range of `count` points (x, y, z [m], sensor frame) at a pose. Points
/// that are not finite have none.
Pairs search_pairs(const MapView & map, const Pose6 & pose, const float * xyz_m, size_t count);

/// Sums over the pairs of `count` points; `d2` is the constant of eq. 6.8.
TangentSums sums_of_pairs(const uint8_t * counts, size_t count, const Pair * pairs, double d2);

}  // namespace manycore::ndt
