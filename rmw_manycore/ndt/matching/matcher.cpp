// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "ndt/matching/matcher.hpp"

#include <algorithm>
#include <string>

#include "platform/error.hpp"

namespace manycore::ndt {
namespace {

/// Convergence threshold of coarse levels, as a fraction of the voxel size: the next finer level
/// converges from anywhere within a voxel.
constexpr double coarse_epsilon_voxels = 0.025;

MatchOptions options_of(const MatchOptions & options, const MapView & level, bool is_last) {
  MatchOptions out = options;
  if (!is_last) {
    const double epsilon_m = coarse_epsilon_voxels * level.header->voxel_size_m;
    out.trans_epsilon = std::max(options.trans_epsilon, epsilon_m);
  }
  return out;
}

}  // namespace

NewtonResult descend(
  const std::vector<MapView> & levels, Problem & problem, const Pose6 & guess,
  const EvaluateProblem & evaluate) {
  NewtonResult result;
  result.pose = guess;
  uint32_t iterations = 0;
  Path path;
  path.add(guess);
  for (size_t i = 0; i < levels.size(); ++i) {
    problem.map = levels[i];
    const MatchOptions options = options_of(problem.options, levels[i], i + 1 == levels.size());
    result =
      maximise(result.pose, options, [&](const Pose6 & pose) { return evaluate(problem, pose); });
    iterations += result.iterations;
    for (uint32_t step = 1; step < result.path.count; ++step) {
      path.add(result.path.poses[step]);
    }
  }
  result.iterations = iterations;
  result.path = path;
  return result;
}

void check_levels(const Levels & levels) {
  const bool has_null = std::find(levels.begin(), levels.end(), nullptr) != levels.end();
  if (levels.empty() || levels.size() > max_levels || has_null) {
    throw Error(
      ErrorCode::invalid_argument, "maps: expected 1 to " + std::to_string(max_levels) +
                                     " levels, none of them null, found " +
                                     std::to_string(levels.size()));
  }
}

std::vector<MapView> views_of(const Levels & levels) {
  check_levels(levels);
  std::vector<MapView> out;
  for (const VoxelMap * level : levels) {
    out.push_back(level->view());
  }
  return out;
}

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
