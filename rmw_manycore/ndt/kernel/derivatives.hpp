// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "ndt/common/matrix.hpp"
#include "ndt/common/options.hpp"
#include "ndt/common/pose.hpp"
#include "ndt/kernel/tangent_sums.hpp"

namespace manycore::ndt {

/// Constants of the Gaussian that approximates the mixture of normal and uniform distribution (eq.
/// 6.8, with PCL's c1 = 10 (1 - outlier ratio) and c2 = outlier ratio / voxel volume).
struct Gaussian {
  double d1;
  double d2;
};

Gaussian gaussian(double outlier_ratio, double voxel_size_m);

/// Score, to be maximised, its derivatives by x, y, z, roll, pitch, yaw, and counts.
struct Derivatives {
  double score = 0;
  double nearest = 0;        ///< sum over the points of the best voxel's score
  double pairs = 0;          ///< pairs of a point and a voxel in range
  double points = 0;         ///< points with at least one voxel in range
  uint64_t scan_points = 0;  ///< finite points of the scan
  Vector6 gradient{};
  Matrix6 hessian{};
};

/// Eq. 6.10, 6.12 and 6.13, from the sums of a pass at this pose.
Derivatives derivatives(const TangentSums & sums, const Gaussian & gaussian, const Pose6 & pose);

/// Pulls the pose along the vehicle's axis towards a position (x, y [m], map frame), as Autoware
/// does where a tunnel or a straight road leaves that direction unconstrained.
struct Regularization {
  double scale_factor;
  double x_m;
  double y_m;
};

/// Adds the regularization to score, gradient and Hessian.
void regularize(const Regularization & regularization, const Pose6 & pose, Derivatives & d);

}  // namespace manycore::ndt
