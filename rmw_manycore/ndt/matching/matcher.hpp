// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "ndt/kernel/pass.hpp"
#include "ndt/kernel/scan.hpp"
#include "ndt/map/voxel_map.hpp"
#include "ndt/optimisation/newton.hpp"

namespace manycore::ndt {

/// Maps of the same points with decreasing voxel sizes, borrowed during the call. A scan is aligned
/// to each in turn, starting from the previous result; scores and derivatives are those of the last
/// that does not polish.
struct Levels {
  std::vector<const VoxelMap *> maps;
  size_t first = 0;      ///< index of the map that the alignment begins on; workers keep all
  size_t polishing = 0;  ///< number of finest maps that only refine the pose
  /// Score that other starts reached on the scored level at the end of the coarser ones; this one
  /// is not followed further unless it reaches more.
  double surpassed = no_score;
  /// Fit (sum of the points' best scores, per point of the scan) that few points have to exceed for
  /// the pose to be refined.
  double min_fit = no_score;

  static constexpr double no_score = -std::numeric_limits<double>::infinity();
};
constexpr size_t max_levels = 6;

/// A scan, the map it is matched to, and the options.
struct Problem {
  MapView map;
  ScanView scan;
  MatchOptions options;
  std::optional<Regularization> regularization;
};

/// Constant d2 of eq. 6.8, in the kernel's precision.
float kernel_d2(const Problem & problem);

/// Adds the bins' sums in the order of the bins, whichever worker computed them.
TangentSums add_bins(const TangentSums (&bins)[bin_count]);

/// Derivatives at a pose, from the sums of all bins at that pose.
Derivatives finish_pass(const Problem & problem, const TangentSums & sums, const Pose6 & pose);

/// Derivatives of a problem at a pose.
using EvaluateProblem = std::function<Derivatives(const Problem &, const Pose6 &)>;

/// Views of the levels that an alignment uses; the last `polishing` only refine the pose.
struct Descent {
  std::vector<MapView> maps;
  size_t polishing = 0;
  double surpassed = Levels::no_score;
  double min_fit = Levels::no_score;

  /// The map of scores and derivatives.
  const MapView & scored() const { return maps[maps.size() - polishing - 1]; }
};

/// Aligns level by level, coarsest first; sets problem.map to each level. Iterations and path cover
/// all levels; the other results are those of the scored level.
NewtonResult descend(
  const Descent & levels, Problem & problem, const Pose6 & guess, const EvaluateProblem & evaluate);

/// Throws Error{invalid_argument} unless there are 1 to max_levels levels, none of them null, and
/// one of those that an alignment uses is scored.
void check_levels(const Levels & levels);

Descent descent_of(const Levels & levels);

/// Computes all bins on the calling thread.
Derivatives evaluate_alone(const Problem & problem, const Kernel & kernel, const Pose6 & pose);

}  // namespace manycore::ndt
