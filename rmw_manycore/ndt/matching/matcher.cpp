// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "ndt/matching/matcher.hpp"

namespace manycore::ndt {

TangentSums add_bins(const TangentSums (&bins)[bin_count]) {
  TangentSums total;
  for (const TangentSums & bin : bins) {
    for (size_t i = 0; i < sum_count; ++i) {
      total.of[i] += bin.of[i];
    }
  }
  return total;
}

Derivatives finish_pass(const Problem & problem, const TangentSums & sums, const Pose6 & pose) {
  const MapHeader & map = *problem.map.header;
  Derivatives d =
    derivatives(sums, gaussian(problem.options.outlier_ratio, map.voxel_size_m), pose);
  if (problem.regularization) {
    regularize(*problem.regularization, pose, d);
  }
  d.scan_points = problem.scan.points;
  return d;
}

float kernel_d2(const Problem & problem) {
  const double voxel_size_m = problem.map.header->voxel_size_m;
  return static_cast<float>(gaussian(problem.options.outlier_ratio, voxel_size_m).d2);
}

Derivatives evaluate_alone(const Problem & problem, const Kernel & kernel, const Pose6 & pose) {
  const PassPose at = pass_pose(pose, *problem.map.header);
  const float d2 = kernel_d2(problem);
  TangentSums bins[bin_count];
  for (size_t bin = 0; bin < bin_count; ++bin) {
    bins[bin] = kernel.pass(problem.map, problem.scan, at, d2, bin);
  }
  return finish_pass(problem, add_bins(bins), pose);
}

}  // namespace manycore::ndt
