// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "ndt/common/aligned_floats.hpp"
#include "ndt/map/voxel_map.hpp"
#include "ndt/matching/matcher.hpp"

namespace manycore::ndt {

/// Where the time of an alignment goes.
struct Profile {
  double lay_out_ns;
  double search_ns;
  double derivatives_ns;
  double total_ns;
};

/// Times the parts of a match on the calling thread. Points are x, y, z [m] in the sensor frame.
class Profiler {
public:
  explicit Profiler(const MatchOptions & options)
  : options_(options), kernel_(kernel_of(choose_simd())) {}

  /// What each of so many passes at a pose takes, without laying out the scan.
  std::vector<double> time_passes_ns(
    const VoxelMap & map, const float * xyz_m, size_t count, const Pose6 & pose, size_t passes);
  /// What each of so many workers' shares of a pass takes when this thread does all of them.
  std::vector<double> time_shares_ns(
    const VoxelMap & map, const float * xyz_m, size_t count, const Pose6 & pose, size_t workers);
  /// An alignment with search and derivatives one after the other, each timed.
  Profile profile(const VoxelMap & map, const float * xyz_m, size_t count, const Pose6 & guess);

private:
  Problem problem(const VoxelMap & map, const float * xyz_m, size_t count);

  MatchOptions options_;
  Kernel kernel_;
  AlignedFloats scan_;
};

}  // namespace manycore::ndt
