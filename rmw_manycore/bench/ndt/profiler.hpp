// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "ndt/common/aligned_floats.hpp"
#include "ndt/map/voxel_map.hpp"
#include "ndt/matching/matcher.hpp"

namespace manycore::ndt {

/// Times of the parts of an alignment.
struct Profile {
  double lay_out_ns;
  double search_ns;
  double derivatives_ns;
  double total_ns;
};

/// Times the parts of an alignment on the calling thread. Points are x, y, z [m] in the sensor
/// frame.
class Profiler {
public:
  explicit Profiler(const MatchOptions & options)
  : options_(options), kernel_(kernel_of(choose_simd())) {}

  /// Time of each of `passes` passes at a pose, without laying out the scan.
  std::vector<double> time_passes_ns(
    const VoxelMap & map, const float * xyz_m, size_t count, const Pose6 & pose, size_t passes);
  /// Time of each of `workers` shares of a pass, all computed by this thread.
  std::vector<double> time_shares_ns(
    const VoxelMap & map, const float * xyz_m, size_t count, const Pose6 & pose, size_t workers);
  /// An alignment with separate, timed search and derivatives.
  Profile profile(const VoxelMap & map, const float * xyz_m, size_t count, const Pose6 & guess);

private:
  Problem problem(const VoxelMap & map, const float * xyz_m, size_t count);

  MatchOptions options_;
  Kernel kernel_;
  AlignedFloats scan_;
};

}  // namespace manycore::ndt
