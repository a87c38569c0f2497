// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace manycore::ndt {

/// Which voxels a point is held against.
enum class Search : uint32_t {
  radius,   ///< those whose mean lies within one resolution of the point, as PCL's kd-tree finds
  direct7,  ///< its own and those across the six faces
  direct1,  ///< its own
};

/// How the covariance of a voxel follows from its n points, S being the sum of (x - mean)(x -
/// mean)'.
enum class VoxelCovariance : uint32_t {
  pcl,       ///< S / (n - 1)
  autoware,  ///< (I + S) / (n - 1): the accumulator starts as the identity (1 m^2)
  pclomp,    ///< (I + S) / n * (n - 1) / n
};

/// How far to go along Newton's direction.
enum class StepRule : uint32_t {
  trust_region,  ///< uphill by the curvature's size, as far as earlier steps turned out well (ours)
  clamped,       ///< its length, at most step_size, without a line search (Autoware's default)
  more_thuente,  ///< More and Thuente's line search up to step_size (PCL)
};

/// Without defaults: those are of MatcherOptions in rmw_manycore_py/ndt.
struct MapOptions {
  double voxel_size_m;
  Search search;
  VoxelCovariance covariance;
  uint32_t min_points_per_voxel;
  double widening_m;  ///< its square is added to the variances of every voxel
};

struct MatchOptions {
  StepRule step_rule;
  uint32_t max_iterations;
  double step_size;  ///< longest step in (m, rad), of clamped and more_thuente
  double trans_epsilon;
  double outlier_ratio;
  double regularization_scale_factor;
};

}  // namespace manycore::ndt
