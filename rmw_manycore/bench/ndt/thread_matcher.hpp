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

/// Matches on threads of this process, woken for each pass: the reference for the worker processes.
/// With separate search threads, these search bin by bin while other threads sum the bins found, as
/// ROS-lite splits the two over clusters (Fig. 15).
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
  std::atomic<uint32_t> searched_[bin_count] = {};  ///< last pass in which the bin was searched
  Gate start_{};
  Gate end_{};
  std::atomic<uint32_t> pass_{0};
  std::atomic<uint32_t> busy_{0};
  std::atomic<bool> stop_{false};
  std::vector<std::thread> threads_;
};

}  // namespace manycore::ndt
