// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "ndt/kernel/derivatives.hpp"

#include <algorithm>

namespace manycore::ndt {
namespace {

Matrix3 full(const double * s) {
  return {{{s[0], s[1], s[2]}, {s[3], s[4], s[5]}, {s[6], s[7], s[8]}}};
}

Matrix3 symmetric(const double * s) {
  return {{{s[0], s[1], s[2]}, {s[1], s[3], s[4]}, {s[2], s[4], s[5]}}};
}

Vector3 transposed_times(const Matrix3 & a, const Vector3 & b) {
  Vector3 out{};
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = 0; j < 3; ++j) {
      out[i] += a[j][i] * b[j];
    }
  }
  return out;
}

}  // namespace

Gaussian gaussian(double outlier_ratio, double voxel_size_m) {
  const double c1 = 10 * (1 - outlier_ratio);
  const double c2 = outlier_ratio / (voxel_size_m * voxel_size_m * voxel_size_m);
  const double d3 = -std::log(c2);
  const double d1 = -std::log(c1 + c2) - d3;
  const double d2 = -2 * std::log((-std::log(c1 * std::exp(-0.5) + c2) - d3) / d1);
  return {d1, d2};
}

Derivatives derivatives(const TangentSums & sums, const Gaussian & gaussian, const Pose6 & pose) {
  const std::array<Vector3, 3> axes = rotation_axes(pose);
  const Matrix3 fq = full(sums.of + sum_fq);
  const Matrix3 m = symmetric(sums.of + sum_m);
  const Matrix3 mq = full(sums.of + sum_mq);
  const Matrix3 qmq = symmetric(sums.of + sum_qmq);
  const double trace = fq[0][0] + fq[1][1] + fq[2][2];
  const Vector3 torque{fq[2][1] - fq[1][2], fq[0][2] - fq[2][0], fq[1][0] - fq[0][1]};
  const double scale = gaussian.d1 * gaussian.d2;

  Derivatives d;
  d.score = -gaussian.d1 * sums.of[sum_score];
  d.nearest = -gaussian.d1 * sums.of[sum_nearest];
  d.pairs = sums.of[sum_pairs];
  d.points = sums.of[sum_points];
  for (size_t k = 0; k < 3; ++k) {
    d.gradient[k] = scale * sums.of[sum_f + k];
    d.gradient[3 + k] = scale * dot(axes[k], torque);
    const Vector3 turned = mq * axes[k];
    for (size_t i = 0; i < 3; ++i) {
      d.hessian[i][k] = scale * m[i][k];
      d.hessian[i][3 + k] = d.hessian[3 + k][i] = scale * turned[i];
    }
    for (size_t l = k; l < 3; ++l) {
      // The last two terms are the sum of f . (a_k x (a_l x q)).
      const double second =
        dot(axes[k], transposed_times(fq, axes[l])) - trace * dot(axes[k], axes[l]);
      d.hessian[3 + k][3 + l] = d.hessian[3 + l][3 + k] =
        scale * (dot(axes[k], qmq * axes[l]) + second);
    }
  }
  return d;
}

void regularize(const Regularization & regularization, const Pose6 & pose, Derivatives & d) {
  const double ahead[2] = {std::cos(pose[5]), std::sin(pose[5])};
  const double distance_m =
    (regularization.x_m - pose[0]) * ahead[0] + (regularization.y_m - pose[1]) * ahead[1];
  const double weight = regularization.scale_factor * d.pairs;
  d.score -= weight * distance_m * distance_m;
  for (size_t i = 0; i < 2; ++i) {
    d.gradient[i] += 2 * weight * distance_m * ahead[i];
    for (size_t j = 0; j < 2; ++j) {
      d.hessian[i][j] -= 2 * weight * ahead[i] * ahead[j];
    }
  }
}

}  // namespace manycore::ndt
