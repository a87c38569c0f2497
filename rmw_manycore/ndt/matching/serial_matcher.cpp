// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "ndt/matching/serial_matcher.hpp"

#include "platform/clock.hpp"

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

bool SerialMatcher::search(PlaceSearch & search, SearchPhase phase, int64_t for_ns) {
  const int64_t end_ns = monotonic_ns() + for_ns;
  search.work(phase, [end_ns] { return monotonic_ns() >= end_ns; });
  return search.is_done();
}

}  // namespace manycore::ndt
