// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "ndt/common/matrix.hpp"
#include "ndt/common/options.hpp"
#include "ndt/common/pose.hpp"
#include "ndt/kernel/tangent_sums.hpp"

namespace manycore::ndt {

/// The constants of the Gaussian that stands for the mixture of normal and uniform distribution
/// (eq. 6.8, with PCL's c1 = 10 (1 - outlier ratio) and c2 = outlier ratio / voxel volume).
struct Gaussian {
  double d1;
  double d2;
};

Gaussian gaussian(double outlier_ratio, double voxel_size_m);

/// Score, to be maximised, and its derivatives by x, y, z, roll, pitch, yaw; and counts.
struct Derivatives {
  double score = 0;
  double nearest = 0;  ///< sum over points of the best voxel's score
  double pairs = 0;
  double points = 0;         ///< that see a voxel
  uint64_t scan_points = 0;  ///< finite points of the scan
  Vector6 gradient{};
  Matrix6 hessian{};
};

/// Eq. 6.10, 6.12 and 6.13 from the sums of a pass at this pose.
Derivatives derivatives(const TangentSums & sums, const Gaussian & gaussian, const Pose6 & pose);

/// Pulls along the vehicle's axis towards a position (x, y [m], map frame), as Autoware does where
/// a tunnel or a straight road leaves that direction open.
struct Regularization {
  double scale_factor;
  double x_m;
  double y_m;
};

void regularize(const Regularization & regularization, const Pose6 & pose, Derivatives & d);

}  // namespace manycore::ndt
