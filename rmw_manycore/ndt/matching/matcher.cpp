// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "ndt/matching/matcher.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "platform/error.hpp"

namespace manycore::ndt {
namespace {

/// Convergence threshold, as a fraction of the voxel size, where something follows that converges
/// from anywhere within a voxel: a finer level, or more points.
constexpr double coarse_epsilon_voxels = 0.025;
/// Points that approach a maximum; a scan of twice as many is thinned for that. Where vehicles hide
/// 40 % of the scan, 2,048 found the right place in fewer scans than all points, 4,096 in as many.
constexpr size_t approach_points = 4096;
/// Points that take the first steps on the scored level, and the threshold that ends these. On
/// coarse levels so few lead astray where half of the map is missing.
constexpr size_t first_points = 1024;
constexpr double first_epsilon_voxels = 0.05;
/// Longest step (m, rad) to the maximum of all points that is taken without looking again.
constexpr double last_step_limit = 0.05;
/// Steps of all points where that is farther; more are taken at wrong places only.
constexpr uint32_t max_last_steps = 3;
/// A polished pose is at most this many of its level's voxels away from the scored level's.
constexpr double polish_voxels = 0.3;
/// Minimum share of the scored level's points that a polishing level sees: where the map is sparse,
/// it has no voxels there.
constexpr double polish_points_share = 0.6;
/// Minimum score of a polished pose on the scored level, whose maximum is lower than its own.
constexpr double polish_score_share = 0.97;

/// Adds the steps of one level to those of all.
void add_steps(const NewtonResult & level, Path & path) {
  for (uint32_t step = 1; step < level.path.count; ++step) {
    path.add(level.path.poses[step]);
  }
}

double apart_m(const Pose6 & a, const Pose6 & b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// Share of a scan's points that see a level.
double share_of(const Derivatives & at) {
  return at.scan_points > 0 ? at.points / static_cast<double>(at.scan_points) : 0;
}

/// Whether a finer level's result may be a better place of the same maximum: near, and seen by most
/// of the points that the scored level sees.
bool may_refine(const NewtonResult & fine, const MapView & map, const NewtonResult & scored) {
  return fine.outcome == Outcome::converged &&
         apart_m(fine.pose, scored.pose) <= polish_voxels * map.header->voxel_size_m &&
         share_of(fine.at) >= polish_points_share * share_of(scored.at);
}

/// An alignment from level to level. Few points, on the scored level fewer ones first, approach the
/// maximum of that level; all of them only refine the pose.
class Steps {
public:
  Steps(const Descent & levels, Problem & problem, const EvaluateProblem & evaluate)
  : levels_(levels), problem_(problem), evaluate_(evaluate), whole_(problem.scan) {
    few_ = levels.polishing > 0 ? thinned(whole_, approach_points) : whole_;
    fewer_ = levels.polishing > 0 ? thinned(whole_, first_points) : whole_;
  }

  NewtonResult from(const Pose6 & guess) {
    path_.add(guess);
    NewtonResult result;
    result.pose = guess;
    for (size_t level = 0; level < scored_; ++level) {
      result = align(level, few_, result.pose, coarse_epsilon_voxels);
    }
    if (!is_surpassed(result)) {
      result = approach(result.pose);
      if (fits_too_little(result)) {
        result.outcome = Outcome::unfinished;
      } else {
        const Derivatives first = result.first;
        finish(result);
        result.first = first;
      }
    }
    result.iterations = iterations_;
    result.path = path_;
    return result;
  }

private:
  /// Whether another start was better at the end of the coarser levels; sets the result if so.
  bool is_surpassed(NewtonResult & result) {
    if (levels_.surpassed == Levels::no_score) {
      return false;
    }
    result.at = result.first = score(fewer_, result.pose);
    if (result.at.score > levels_.surpassed) {
      return false;
    }
    result.outcome = Outcome::surpassed;
    return true;
  }

  bool fits_too_little(const NewtonResult & found) const {
    return found.outcome == Outcome::converged &&
           found.at.nearest <= levels_.min_fit * static_cast<double>(found.at.scan_points);
  }

  /// Aligns to the scored level; `first` of the result is that of the first steps.
  NewtonResult approach(const Pose6 & guess) {
    const double epsilon_voxels = few_.is_thinned() ? coarse_epsilon_voxels : 0;
    if (!fewer_.is_thinned()) {
      return align(scored_, few_, guess, epsilon_voxels);
    }
    const NewtonResult near = align(scored_, fewer_, guess, first_epsilon_voxels);
    NewtonResult found = align(scored_, few_, near.pose, epsilon_voxels);
    found.first = near.first;
    return found;
  }

  /// Aligns to a level, and adds the steps to those of all.
  NewtonResult align(
    size_t level, const ScanView & scan, const Pose6 & guess, double epsilon_voxels) {
    MatchOptions options = problem_.options;
    const double epsilon_m = epsilon_voxels * levels_.maps[level].header->voxel_size_m;
    options.trans_epsilon = std::max(options.trans_epsilon, epsilon_m);
    const NewtonResult found = maximised(level, scan, guess, options);
    add_steps(found, path_);
    return found;
  }

  NewtonResult maximised(
    size_t level, const ScanView & scan, const Pose6 & guess, const MatchOptions & options) {
    problem_.map = levels_.maps[level];
    problem_.scan = scan;
    const NewtonResult found =
      maximise(guess, options, [&](const Pose6 & pose) { return evaluate_(problem_, pose); });
    iterations_ += found.iterations;
    return found;
  }

  Derivatives score(const ScanView & scan, const Pose6 & pose) {
    problem_.map = levels_.scored();
    problem_.scan = scan;
    return evaluate_(problem_, pose);
  }

  /// Refines the scored level's result: on the finer levels, else with all points on this one.
  void finish(NewtonResult & result) {
    const bool is_thinned = few_.is_thinned();
    bool is_polished = false;
    for (size_t i = scored_ + 1; i < levels_.maps.size() && polish(i, result); ++i) {
      is_polished = true;
    }
    if (is_thinned) {
      if (!is_polished) {
        result = with_all(scored_, result);
        path_.add(result.pose);
      }
      result.at = score(whole_, result.pose);
    }
  }

  /// Moves a result to a finer level's; false if that does not refine it.
  bool polish(size_t level, NewtonResult & result) {
    if (result.outcome != Outcome::converged) {
      return false;
    }
    const MapView & map = levels_.maps[level];
    NewtonResult fine = maximised(level, few_, result.pose, problem_.options);
    if (!may_refine(fine, map, result)) {
      return false;
    }
    fine = with_all(level, fine);
    const Derivatives there = score(few_, fine.pose);
    if (!may_refine(fine, map, result) || !(there.score >= polish_score_share * result.at.score)) {
      return false;
    }
    add_steps(fine, path_);
    result.pose = fine.pose;
    result.at = there;
    return true;
  }

  /// Moves what few points found to the maximum of all. If that is near, one step of Newton's is
  /// enough: its error is quadratic.
  NewtonResult with_all(size_t level, const NewtonResult & found) {
    if (!few_.is_thinned() || found.outcome != Outcome::converged) {
      return found;
    }
    problem_.map = levels_.maps[level];
    problem_.scan = whole_;
    const Derivatives at = evaluate_(problem_, found.pose);
    const std::optional<Matrix6> covariance = laplace_covariance(at.hessian);
    const Vector6 step = covariance ? *covariance * at.gradient : Vector6{};
    if (!covariance || !(norm(step) <= last_step_limit)) {
      MatchOptions options = problem_.options;
      options.max_iterations = std::min(options.max_iterations, max_last_steps);
      return maximised(level, whole_, found.pose, options);
    }
    ++iterations_;
    NewtonResult out = found;
    for (size_t i = 0; i < step.size(); ++i) {
      out.pose[i] += step[i];
    }
    out.path.add(out.pose);
    return out;
  }

  const Descent & levels_;
  Problem & problem_;
  const EvaluateProblem & evaluate_;
  ScanView whole_;
  ScanView few_;
  ScanView fewer_;
  size_t scored_ = levels_.maps.size() - levels_.polishing - 1;
  uint32_t iterations_ = 0;
  Path path_;
};

}  // namespace

NewtonResult descend(
  const Descent & levels, Problem & problem, const Pose6 & guess,
  const EvaluateProblem & evaluate) {
  return Steps(levels, problem, evaluate).from(guess);
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
  Descent out{{}, levels.polishing, levels.surpassed, levels.min_fit};
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
