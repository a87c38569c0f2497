// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "ndt/matcher.hpp"

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
  return d;
}

Derivatives evaluate_alone(const Problem & problem, BinPass bin_pass, const Pose6 & pose) {
  const MapHeader & map = *problem.map.header;
  const PassPose at = pass_pose(pose, map);
  const Gaussian constants = gaussian(problem.options.outlier_ratio, map.voxel_size_m);
  TangentSums bins[bin_count];
  for (size_t bin = 0; bin < bin_count; ++bin) {
    bins[bin] = bin_pass(problem.map, problem.scan, at, static_cast<float>(constants.d2), bin);
  }
  return finish_pass(problem, add_bins(bins), pose);
}

}  // namespace manycore::ndt
