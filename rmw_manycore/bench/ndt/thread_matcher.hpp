// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

#include "ndt/common/aligned_floats.hpp"
#include "ndt/matching/matcher.hpp"
#include "ndt/matching/worker_session.hpp"

namespace manycore::ndt {

/// Matches on threads of this process, woken for every pass: what workers are measured against.
/// With threads of their own for the search, these find lists bin by bin and others add up behind
/// them, as ROS-lite spreads the two over clusters (Fig. 15).
class ThreadMatcher {
public:
  ThreadMatcher(
    const MatchOptions & options, const std::vector<int> & derivative_cpus,
    const std::vector<int> & search_cpus);
  ~ThreadMatcher();

  NewtonResult align(
    const Levels & levels, const float * xyz_m, size_t count, const Pose6 & guess,
    const std::optional<Regularization> & regularization);
  Derivatives evaluate(
    const Levels & levels, const float * xyz_m, size_t count, const Pose6 & pose);

private:
  void put(const MapView & map, const float * xyz_m, size_t count);
  Derivatives run_pass(const Pose6 & pose);
  void run(int cpu, bool is_search, size_t index);
  void search(size_t index);
  void derive(size_t index);

  MatchOptions options_;
  Kernel kernel_;
  size_t derivative_threads_;
  size_t search_threads_;
  int64_t caller_spin_ns_;
  AlignedFloats scan_;
  std::vector<uint32_t> found_;
  Problem problem_{};
  PassPose pose_{};
  TangentSums bins_[bin_count];
  std::atomic<uint32_t> searched_[bin_count] = {};  ///< last pass whose lists of the bin are there
  Gate start_{};
  Gate end_{};
  std::atomic<uint32_t> pass_{0};
  std::atomic<uint32_t> busy_{0};
  std::atomic<bool> stop_{false};
  std::vector<std::thread> threads_;
};

}  // namespace manycore::ndt
