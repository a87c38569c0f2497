// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "ndt/trust_region.hpp"

#include <algorithm>
#include <cmath>

namespace manycore::ndt {
namespace {

/// The step uphill, in metres: angles times the lever.
Vector6 uphill_step(const Derivatives & at, const Vector6 & unit) {
  Vector6 gradient;
  Matrix6 hessian;
  for (size_t i = 0; i < 6; ++i) {
    gradient[i] = at.gradient[i] * unit[i];
    for (size_t j = 0; j < 6; ++j) {
      hessian[i][j] = at.hessian[i][j] * unit[i] * unit[j];
    }
  }
  const Eigen<6> eigen = symmetric_eigen(hessian);
  double largest = 0;
  for (const double value : eigen.values) {
    largest = std::max(largest, std::abs(value));
  }
  // A direction that is flat to rounding is bounded by the radius alone.
  const double flat = 1e-12 * largest;
  return eigen.map([&](double value) { return 1 / std::max(std::abs(value), flat); }) * gradient;
}

}  // namespace

double TrustRegion::step(NewtonResult & result, const Evaluate & evaluate) {
  constexpr double angle = 1 / lever_m;
  const Vector6 unit{1, 1, 1, angle, angle, angle};
  const Vector6 step = uphill_step(result.at, unit);
  const double newton_m = norm(step);
  if (!std::isfinite(newton_m) || newton_m == 0) {
    return 0;
  }
  const double length_m = std::min(newton_m, radius_m_);
  Pose6 pose = result.pose;
  for (size_t i = 0; i < 6; ++i) {
    pose[i] += step[i] * unit[i] * length_m / newton_m;
  }
  const Derivatives at = evaluate(pose);
  if (!(at.score >= result.at.score)) {
    radius_m_ = length_m / 4;
    return radius_m_;
  }
  result.pose = pose;
  result.at = at;
  if (length_m == radius_m_) {
    radius_m_ = std::min(2 * radius_m_, largest_radius_m);
  }
  return length_m;
}

}  // namespace manycore::ndt
