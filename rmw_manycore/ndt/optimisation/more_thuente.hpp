// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace manycore::ndt {

/// Value and slope of a function of one variable, at a length along a line.
struct LinePoint {
  double length;
  double value;
  double slope;
};

/// More and Thuente's line search (1994) with PCL's constants: at most 10 trials, sufficient
/// decrease 1e-4, curvature 0.9. Returns the last length passed to `evaluate`, between least and
/// most. `origin` is the point at length 0, where the slope is negative.
double more_thuente(
  const LinePoint & origin, double first, double least, double most,
  const std::function<LinePoint(double)> & evaluate);

}  // namespace manycore::ndt
