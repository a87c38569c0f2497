// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ndt/optimisation/newton.hpp"

namespace manycore::ndt {

/// A step rule of this project. Far from the optimum the score is not concave, and Newton's step
/// leads away from it along each direction of positive curvature. Here each eigenvalue of the
/// Hessian counts by its magnitude, so each step ascends. A radius bounds the step length, adapted
/// by how well the quadratic model predicted the gain (Nocedal and Wright, Numerical Optimization,
/// algorithm 4.1). A step that lowers the score is undone.
class TrustRegion {
public:
  /// One step, with one evaluation. Returns the bound on the error of the next step: the length of
  /// the step, or the remaining radius if the step was undone; 0 if there is no direction.
  double step(NewtonResult & result, const Evaluate & evaluate);

private:
  static constexpr double first_radius_m = 0.5;
  static constexpr double largest_radius_m = 1.0;
  /// A rotation counts as the displacement of a point at this distance.
  static constexpr double lever_m = 10.0;

  double radius_m_ = first_radius_m;
};

}  // namespace manycore::ndt
