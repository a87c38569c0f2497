// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ndt/optimisation/newton.hpp"

namespace manycore::ndt {

/// A step rule of our own. Far from the optimum the score is not concave, and Newton's step leads
/// away from it along every direction that curves upwards; here each eigenvalue of the Hessian
/// counts by its size, so every step leads uphill. Its length is bounded by a radius that follows
/// how well the quadratic model foretold the gain (Nocedal and Wright, Numerical Optimization,
/// algorithm 4.1). A step that lowered the score is taken back.
class TrustRegion {
public:
  /// One evaluation. Returns the bound on the next step's error: the length of the step taken, or
  /// the radius left after one that was taken back; 0 where there is no direction.
  double step(NewtonResult & result, const Evaluate & evaluate);

private:
  static constexpr double first_radius_m = 0.5;
  static constexpr double largest_radius_m = 1.0;
  /// A turn by an angle counts as the way of a point so far off.
  static constexpr double lever_m = 10.0;

  double radius_m_ = first_radius_m;
};

}  // namespace manycore::ndt
