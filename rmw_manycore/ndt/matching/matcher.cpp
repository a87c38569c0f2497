// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "ndt/matching/matcher.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "platform/error.hpp"

namespace manycore::ndt {
namespace {

/// Convergence threshold of coarse levels, as a fraction of the voxel size: the next finer level
/// converges from anywhere within a voxel.
constexpr double coarse_epsilon_voxels = 0.025;
/// A polished pose is at most this many of its level's voxels away from the scored level's.
constexpr double polish_voxels = 0.3;
/// Minimum share of the scored level's points that a polishing level sees: where the map is sparse,
/// it has no voxels there.
constexpr double polish_points_share = 0.6;
/// Minimum score of a polished pose on the scored level, whose maximum is lower than its own.
constexpr double polish_score_share = 0.97;

MatchOptions options_of(const MatchOptions & options, const MapView & level, bool is_last) {
  MatchOptions out = options;
  if (!is_last) {
    const double epsilon_m = coarse_epsilon_voxels * level.header->voxel_size_m;
    out.trans_epsilon = std::max(options.trans_epsilon, epsilon_m);
  }
  return out;
}

/// Adds the steps of one level to those of all.
void add_steps(const NewtonResult & level, Path & path) {
  for (uint32_t step = 1; step < level.path.count; ++step) {
    path.add(level.path.poses[step]);
  }
}

double apart_m(const Pose6 & a, const Pose6 & b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// Whether a finer level's result is a better place of the same maximum: near, seen by most of the
/// points that the scored level sees, and no worse there.
bool refines(
  const NewtonResult & fine, const MapView & map, const NewtonResult & scored,
  const Derivatives & at) {
  return fine.outcome == Outcome::converged &&
         apart_m(fine.pose, scored.pose) <= polish_voxels * map.header->voxel_size_m &&
         fine.at.points >= polish_points_share * scored.at.points &&
         at.score >= polish_score_share * scored.at.score;
}

}  // namespace

NewtonResult descend(
  const Descent & levels, Problem & problem, const Pose6 & guess,
  const EvaluateProblem & evaluate) {
  const auto at = [&](const Pose6 & pose) { return evaluate(problem, pose); };
  const size_t scored = levels.maps.size() - levels.polishing - 1;
  NewtonResult result;
  result.pose = guess;
  uint32_t iterations = 0;
  Path path;
  path.add(guess);
  const auto align_to = [&](size_t level) {
    problem.map = levels.maps[level];
    const bool is_last = level == scored || level + 1 == levels.maps.size();
    const MatchOptions options = options_of(problem.options, problem.map, is_last);
    const NewtonResult found = maximise(result.pose, options, at);
    iterations += found.iterations;
    return found;
  };
  for (size_t i = 0; i <= scored; ++i) {
    result = align_to(i);
    add_steps(result, path);
  }
  const Derivatives first = result.first;
  for (size_t i = scored + 1; i < levels.maps.size() && result.outcome == Outcome::converged; ++i) {
    const NewtonResult fine = align_to(i);
    problem.map = levels.scored();
    const Derivatives there = at(fine.pose);
    if (!refines(fine, levels.maps[i], result, there)) {
      break;
    }
    add_steps(fine, path);
    result.pose = fine.pose;
    result.at = there;
  }
  result.first = first;
  result.iterations = iterations;
  result.path = path;
  return result;
}

void check_levels(const Levels & levels) {
  const auto & maps = levels.maps;
  const bool has_null = std::find(maps.begin(), maps.end(), nullptr) != maps.end();
  if (maps.empty() || maps.size() > max_levels || has_null) {
    throw Error(
      ErrorCode::invalid_argument, "maps: expected 1 to " + std::to_string(max_levels) +
                                     " levels, none of them null, found " +
                                     std::to_string(maps.size()));
  }
  if (levels.first + levels.polishing >= maps.size()) {
    throw Error(ErrorCode::invalid_argument, "maps: expected a scored level, found none");
  }
}

Descent descent_of(const Levels & levels) {
  check_levels(levels);
  Descent out{{}, levels.polishing};
  for (size_t i = levels.first; i < levels.maps.size(); ++i) {
    out.maps.push_back(levels.maps[i]->view());
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
