// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace manycore::ndt {

/// Voxels that a point is compared with.
enum class Search : uint32_t {
  radius,   ///< voxels whose mean is within one voxel size of the point, as found by PCL's kd-tree
  direct7,  ///< the point's own voxel and its six face neighbours
  direct1,  ///< the point's own voxel
};

/// Covariance of a voxel with n points, where S is the sum of (x - mean)(x - mean)'.
enum class VoxelCovariance : uint32_t {
  pcl,       ///< S / (n - 1)
  autoware,  ///< (I + S) / (n - 1): the accumulator starts as the identity (1 m^2)
  pclomp,    ///< (I + S) / n * (n - 1) / n
};

/// Step length along Newton's direction.
enum class StepRule : uint32_t {
  trust_region,  ///< eigenvalues by magnitude, length bounded by an adaptive radius (this project)
  clamped,       ///< Newton's length, at most step_size, no line search (Autoware's default)
  more_thuente,  ///< More and Thuente's line search up to step_size (PCL)
};

/// No default values: these are in MatcherOptions of rmw_manycore_py/ndt.
struct MapOptions {
  double voxel_size_m;
  Search search;
  VoxelCovariance covariance;
  uint32_t min_points_per_voxel;
  double widening_m;  ///< its square is added to the variances of each voxel
};

/// As MapOptions, for the alignment.
struct MatchOptions {
  StepRule step_rule;
  uint32_t max_iterations;
  double step_size;  ///< longest step in (m, rad), for clamped and more_thuente
  double trans_epsilon;
  double outlier_ratio;
  double regularization_scale_factor;
};

}  // namespace manycore::ndt
