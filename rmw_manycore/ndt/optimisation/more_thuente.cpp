// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "ndt/optimisation/more_thuente.hpp"

#include <algorithm>
#include <cmath>

namespace manycore::ndt {
namespace {

constexpr double sufficient_decrease = 1e-4;
constexpr double curvature = 0.9;
constexpr int max_trials = 10;

/// Minimiser of the cubic through two points with given slopes.
double cubic(const LinePoint & a, const LinePoint & b) {
  const double z = 3 * (b.value - a.value) / (b.length - a.length) - b.slope - a.slope;
  const double w = std::sqrt(std::max(z * z - b.slope * a.slope, 0.0));
  return a.length + (b.length - a.length) * (w - a.slope - z) / (b.slope - a.slope + 2 * w);
}

/// Minimiser of the quadratic through two points with the slope of the first.
double quadratic(const LinePoint & a, const LinePoint & b) {
  const double chord = (a.value - b.value) / (a.length - b.length);
  return a.length - 0.5 * (a.length - b.length) * a.slope / (a.slope - chord);
}

/// Minimiser of the quadratic with the slopes of two points.
double secant(const LinePoint & a, const LinePoint & b) {
  return a.length - (a.length - b.length) / (a.slope - b.slope) * a.slope;
}

/// Section 4 of the paper: next trial length, given the best point and the other end.
double next_length(const LinePoint & best, const LinePoint & other, const LinePoint & trial) {
  const auto distance = [](double from, double to) { return std::abs(from - to); };
  if (trial.value > best.value) {
    const double c = cubic(best, trial);
    const double q = quadratic(best, trial);
    return distance(c, best.length) < distance(q, best.length) ? c : 0.5 * (q + c);
  }
  if (trial.slope * best.slope < 0) {
    const double c = cubic(best, trial);
    const double s = secant(best, trial);
    return distance(c, trial.length) >= distance(s, trial.length) ? c : s;
  }
  if (std::abs(trial.slope) <= std::abs(best.slope)) {
    const double c = cubic(best, trial);
    const double s = secant(best, trial);
    const double nearer = distance(c, trial.length) < distance(s, trial.length) ? c : s;
    const double bound = trial.length + 0.66 * (other.length - trial.length);
    return trial.length > best.length ? std::min(bound, nearer) : std::max(bound, nearer);
  }
  return cubic(other, trial);
}

/// Updates the interval (section 2); true when it has shrunk to a point.
bool shrink(LinePoint & best, LinePoint & other, const LinePoint & trial) {
  if (trial.value > best.value) {
    other = trial;
    return false;
  }
  const double ahead = trial.slope * (best.length - trial.length);
  if (ahead < 0) {
    other = best;
  }
  best = trial;
  return ahead == 0;
}

}  // namespace

double more_thuente(
  const LinePoint & origin, double first, double least, double most,
  const std::function<LinePoint(double)> & evaluate) {
  // Until the interval is closed, search for a minimum of psi (eq. 2.1) instead of phi.
  const double tilt = sufficient_decrease * origin.slope;
  const auto psi = [&](const LinePoint & phi) {
    return LinePoint{phi.length, phi.value - origin.value - tilt * phi.length, phi.slope - tilt};
  };
  const auto phi_of = [&](const LinePoint & p) {
    return LinePoint{p.length, p.value + origin.value + tilt * p.length, p.slope + tilt};
  };
  LinePoint best = psi(origin);
  LinePoint other = best;
  LinePoint phi = evaluate(first);
  bool is_open = true;
  for (int trial = 0; trial < max_trials; ++trial) {
    // As in PCL, a slope that still descends steeply is accepted: the next iteration continues from
    // there.
    const bool is_good = psi(phi).value <= 0 && phi.slope <= -curvature * origin.slope;
    if (is_good) {
      break;
    }
    const double next = next_length(best, other, is_open ? psi(phi) : phi);
    const double bounded = std::isfinite(next) ? std::clamp(next, least, most) : least;
    if (bounded == phi.length) {
      break;
    }
    phi = evaluate(bounded);
    if (is_open && psi(phi).value <= 0 && psi(phi).slope >= 0) {
      is_open = false;
      best = phi_of(best);
      other = phi_of(other);
    }
    if (shrink(best, other, is_open ? psi(phi) : phi)) {
      break;
    }
  }
  return phi.length;
}

}  // namespace manycore::ndt
