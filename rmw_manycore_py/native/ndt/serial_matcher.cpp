// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "ndt/serial_matcher.hpp"

#include "platform/clock.hpp"

namespace manycore::ndt {

Problem SerialMatcher::problem(const VoxelMap & map, const float * xyz_m, size_t count) {
  const ScanView scan =
    lay_out_scan(xyz_m, count, scan_.with_room_for(scan_floats(count)));
  used_points_ = scan.points;
  return {map.view(), scan, options_, std::nullopt};
}

NewtonResult SerialMatcher::align(
  const VoxelMap & map, const float * xyz_m, size_t count, const Pose6 & guess,
  const std::optional<Regularization> & regularization) {
  Problem matched = problem(map, xyz_m, count);
  matched.regularization = regularization;
  return maximise(guess, options_, [&](const Pose6 & pose) {
    return evaluate_alone(matched, bin_pass_, pose);
  });
}

Derivatives SerialMatcher::evaluate(
  const VoxelMap & map, const float * xyz_m, size_t count, const Pose6 & pose) {
  return evaluate_alone(problem(map, xyz_m, count), bin_pass_, pose);
}

std::vector<double> SerialMatcher::time_passes_ns(
  const VoxelMap & map, const float * xyz_m, size_t count, const Pose6 & pose, size_t passes) {
  const Problem matched = problem(map, xyz_m, count);
  std::vector<double> times_ns;
  for (size_t i = 0; i < passes; ++i) {
    const int64_t start_ns = monotonic_ns();
    evaluate_alone(matched, bin_pass_, pose);
    times_ns.push_back(static_cast<double>(monotonic_ns() - start_ns));
  }
  return times_ns;
}

}  // namespace manycore::ndt
