// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "ndt/matching/serial_matcher.hpp"

namespace manycore::ndt {

Problem SerialMatcher::problem(const VoxelMap & map, const float * xyz_m, size_t count) {
  const ScanView scan = lay_out_scan(xyz_m, count, scan_.with_room_for(scan_floats(count)));
  return {map.view(), scan, options_, std::nullopt};
}

NewtonResult SerialMatcher::align(
  const VoxelMap & map, const float * xyz_m, size_t count, const Pose6 & guess,
  const std::optional<Regularization> & regularization) {
  Problem matched = problem(map, xyz_m, count);
  matched.regularization = regularization;
  return maximise(
    guess, options_, [&](const Pose6 & pose) { return evaluate_alone(matched, kernel_, pose); });
}

Derivatives SerialMatcher::evaluate(
  const VoxelMap & map, const float * xyz_m, size_t count, const Pose6 & pose) {
  return evaluate_alone(problem(map, xyz_m, count), kernel_, pose);
}

}  // namespace manycore::ndt
