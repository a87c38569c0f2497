// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "ndt/common/aligned_floats.hpp"
#include "ndt/matching/matcher.hpp"
#include "ndt/search/place_search.hpp"

namespace manycore::ndt {

/// Matches on the calling thread.
class SerialMatcher {
public:
  explicit SerialMatcher(const MatchOptions & options)
  : options_(options), kernel_(kernel_of(choose_simd())) {}

  /// Aligns points x, y, z [m] in the sensor frame; ignores those that are not finite.
  NewtonResult align(
    const Levels & levels, const float * xyz_m, size_t count, const Pose6 & guess,
    const std::optional<Regularization> & regularization);
  /// Derivatives at a pose, on the scored level.
  Derivatives evaluate(
    const Levels & levels, const float * xyz_m, size_t count, const Pose6 & pose);
  /// Works on a phase of a search for about `for_ns`; true if all of it is done.
  static bool search(PlaceSearch & search, SearchPhase phase, int64_t for_ns);

private:
  Problem problem(const MapView & map, const float * xyz_m, size_t count);

  MatchOptions options_;
  Kernel kernel_;
  AlignedFloats scan_;
};

}  // namespace manycore::ndt
