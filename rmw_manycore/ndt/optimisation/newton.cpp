// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "ndt/optimisation/newton.hpp"

#include <algorithm>
#include <cmath>

#include "ndt/optimisation/more_thuente.hpp"
#include "ndt/optimisation/trust_region.hpp"

namespace manycore::ndt {
namespace {

Pose6 moved(const Pose6 & pose, const Vector6 & direction, double length) {
  Pose6 out = pose;
  for (size_t i = 0; i < 6; ++i) {
    out[i] += length * direction[i];
  }
  return out;
}

/// Step rules of published matchers: Newton's direction, then a step length. Returns the length, 0
/// if there is no direction.
double step_along_newton(
  NewtonResult & result, const MatchOptions & options, const Evaluate & evaluate) {
  Vector6 direction = newton_step(result.at.hessian, result.at.gradient);
  const double newton_length = norm(direction);
  if (!std::isfinite(newton_length) || newton_length == 0) {
    return 0;
  }
  // Where the score is not concave, Newton's step may descend: reverse it then.
  const double way = dot(direction, result.at.gradient) < 0 ? -1 : 1;
  for (double & element : direction) {
    element *= way / newton_length;
  }
  const double least = options.trans_epsilon / 2;
  const double first = std::max(std::min(newton_length, options.step_size), least);
  const Pose6 start = result.pose;
  const auto try_length = [&](double length) {
    result.pose = moved(start, direction, length);
    result.at = evaluate(result.pose);
    // Line searches minimise, so use value and slope of the negative score.
    return LinePoint{length, -result.at.score, -dot(result.at.gradient, direction)};
  };
  if (options.step_rule == StepRule::clamped) {
    return try_length(first).length;
  }
  const LinePoint origin{0, -result.at.score, -dot(result.at.gradient, direction)};
  return more_thuente(origin, first, least, options.step_size, try_length);
}

bool is_usable(const Derivatives & d) {
  return std::isfinite(d.score) && is_finite(d.gradient) && norm(d.gradient) > 0;
}

}  // namespace

Vector6 newton_step(const Matrix6 & hessian, const Vector6 & gradient) {
  const Eigen<6> eigen = symmetric_eigen(hessian);
  double largest = 0;
  for (const double value : eigen.values) {
    largest = std::max(largest, std::abs(value));
  }
  constexpr double rank_tolerance = 6 * 2.2e-16;
  const Matrix6 inverse = eigen.map(
    [&](double value) { return std::abs(value) > rank_tolerance * largest ? -1 / value : 0.0; });
  return inverse * gradient;
}

std::optional<Matrix6> laplace_covariance(const Matrix6 & hessian) {
  const Eigen<6> eigen = symmetric_eigen(hessian);
  const auto & values = eigen.values;
  if (!std::all_of(values.begin(), values.end(), [](double value) { return value < 0; })) {
    return std::nullopt;
  }
  return eigen.map([](double value) { return -1 / value; });
}

NewtonResult maximise(
  const Pose6 & guess, const MatchOptions & options, const Evaluate & evaluate) {
  NewtonResult result;
  result.pose = guess;
  result.at = result.first = evaluate(guess);
  result.path.add(guess);
  TrustRegion trust_region;
  while (result.iterations < options.max_iterations) {
    if (result.at.pairs == 0) {
      result.outcome = Outcome::no_overlap;
      return result;
    }
    if (!is_usable(result.at)) {
      result.outcome = Outcome::degenerate;
      return result;
    }
    const double length = options.step_rule == StepRule::trust_region
                            ? trust_region.step(result, evaluate)
                            : step_along_newton(result, options, evaluate);
    ++result.iterations;
    result.path.add(result.pose);
    if (length == 0) {
      result.outcome = Outcome::degenerate;
      return result;
    }
    if (length < options.trans_epsilon) {
      result.outcome = result.at.pairs > 0 ? Outcome::converged : Outcome::no_overlap;
      return result;
    }
  }
  return result;
}

}  // namespace manycore::ndt
