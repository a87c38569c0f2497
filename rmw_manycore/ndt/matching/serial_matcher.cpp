// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "ndt/matching/serial_matcher.hpp"

namespace manycore::ndt {

Problem SerialMatcher::problem(const MapView & map, const float * xyz_m, size_t count) {
  const ScanView scan = lay_out_scan(xyz_m, count, scan_.with_room_for(scan_floats(count)));
  return {map, scan, options_, std::nullopt};
}

NewtonResult SerialMatcher::align(
  const Levels & levels, const float * xyz_m, size_t count, const Pose6 & guess,
  const std::optional<Regularization> & regularization) {
  const Descent descent = descent_of(levels);
  Problem matched = problem(descent.scored(), xyz_m, count);
  matched.regularization = regularization;
  return descend(descent, matched, guess, [&](const Problem & level, const Pose6 & pose) {
    return evaluate_alone(level, kernel_, pose);
  });
}

Derivatives SerialMatcher::evaluate(
  const Levels & levels, const float * xyz_m, size_t count, const Pose6 & pose) {
  return evaluate_alone(problem(descent_of(levels).scored(), xyz_m, count), kernel_, pose);
}

}  // namespace manycore::ndt
