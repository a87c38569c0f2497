// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "ndt/kernel/pass.hpp"
#include "ndt/kernel/scan.hpp"
#include "ndt/map/voxel_map.hpp"
#include "ndt/optimisation/newton.hpp"

namespace manycore::ndt {

/// Maps of the same points with smaller and smaller voxels; a scan is aligned to each, from where
/// the one before has led. The last one's alignment counts. Borrowed for the call.
using Levels = std::vector<const VoxelMap *>;
constexpr size_t max_levels = 4;

/// What is matched: a scan to a map.
struct Problem {
  MapView map;
  ScanView scan;
  MatchOptions options;
  std::optional<Regularization> regularization;
};

/// d2 of eq. 6.8 as the kernel takes it.
float kernel_d2(const Problem & problem);

/// All bins' sums added in the order of the bins, whoever computed them.
TangentSums add_bins(const TangentSums (&bins)[bin_count]);

/// Derivatives at a pose, from the sums of all bins there.
Derivatives finish_pass(const Problem & problem, const TangentSums & sums, const Pose6 & pose);

/// Derivatives of a problem at a pose.
using EvaluateProblem = std::function<Derivatives(const Problem &, const Pose6 &)>;

/// Aligns level by level, coarsest first; problem.map is set to each. Iterations and path are those
/// of all levels together, the rest is the last level's.
NewtonResult descend(
  const std::vector<MapView> & levels, Problem & problem, const Pose6 & guess,
  const EvaluateProblem & evaluate);

/// Throws Error{invalid_argument} unless there are 1 to max_levels.
void check_levels(const Levels & levels);

std::vector<MapView> views_of(const Levels & levels);

/// One core does all bins.
Derivatives evaluate_alone(const Problem & problem, const Kernel & kernel, const Pose6 & pose);

}  // namespace manycore::ndt
