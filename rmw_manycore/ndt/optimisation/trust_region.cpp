// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "ndt/optimisation/trust_region.hpp"

#include <algorithm>
#include <cmath>

namespace manycore::ndt {
namespace {

/// Quadratic model of the score near a pose, for steps in metres: angles are multiplied by the
/// lever.
struct Model {
  Vector6 gradient;
  Matrix6 hessian;

  Model(const Derivatives & at, const Vector6 & unit) {
    for (size_t i = 0; i < 6; ++i) {
      gradient[i] = at.gradient[i] * unit[i];
      for (size_t j = 0; j < 6; ++j) {
        hessian[i][j] = at.hessian[i][j] * unit[i] * unit[j];
      }
    }
  }

  double gain(const Vector6 & step) const {
    return dot(gradient, step) + 0.5 * dot(step, hessian * step);
  }
};

Vector6 uphill_step(const Model & model) {
  const Eigen<6> eigen = symmetric_eigen(model.hessian);
  double largest = 0;
  for (const double value : eigen.values) {
    largest = std::max(largest, std::abs(value));
  }
  // The radius alone bounds a direction that is flat to rounding.
  const double flat = 1e-12 * largest;
  return eigen.map([&](double value) { return 1 / std::max(std::abs(value), flat); }) *
         model.gradient;
}

}  // namespace

double TrustRegion::step(NewtonResult & result, const Evaluate & evaluate) {
  constexpr double angle = 1 / lever_m;
  const Vector6 unit{1, 1, 1, angle, angle, angle};
  const Model model(result.at, unit);
  Vector6 step = uphill_step(model);
  const double newton_m = norm(step);
  if (!std::isfinite(newton_m) || newton_m == 0) {
    return 0;
  }
  const double length_m = std::min(newton_m, radius_m_);
  Pose6 pose = result.pose;
  for (size_t i = 0; i < 6; ++i) {
    step[i] *= length_m / newton_m;
    pose[i] += step[i] * unit[i];
  }
  const Derivatives at = evaluate(pose);
  if (!(at.score >= result.at.score)) {
    radius_m_ = length_m / 4;
    return radius_m_;
  }
  const double gain = at.score - result.at.score;
  const double foretold = model.gain(step);
  result.pose = pose;
  result.at = at;
  if (gain < 0.25 * foretold) {
    radius_m_ = length_m / 2;
  } else if (gain > 0.75 * foretold && length_m == radius_m_) {
    radius_m_ = std::min(2 * radius_m_, largest_radius_m);
  }
  return length_m;
}

}  // namespace manycore::ndt
