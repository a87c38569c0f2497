// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "bench/ndt/thread_matcher.hpp"

#include "platform/clock.hpp"
#include "platform/cpu.hpp"
#include "platform/os_process.hpp"

namespace manycore::ndt {
namespace {

constexpr int64_t thread_spin_ns = 200'000;

/// Spins for `spin_ns`, then sleeps.
template<typename Condition>
void wait_at(Gate & gate, Condition is_due, int64_t spin_ns) {
  const int64_t deadline_ns = monotonic_ns() + spin_ns;
  while (monotonic_ns() < deadline_ns) {
    if (is_due()) {
      return;
    }
    pause_cpu();
  }
  sleep_until(gate, is_due, std::nullopt);
}

}  // namespace

ThreadMatcher::ThreadMatcher(
  const MatchOptions & options, const std::vector<int> & derivative_cpus,
  const std::vector<int> & search_cpus)
: options_(options),
  kernel_(kernel_of(choose_simd())),
  derivative_threads_(derivative_cpus.size()),
  search_threads_(search_cpus.size()),
  // The caller must not take a CPU from the threads that it waits for.
  caller_spin_ns_(
    derivative_threads_ + search_threads_ < std::thread::hardware_concurrency() ? thread_spin_ns
                                                                                : 0) {
  for (size_t i = 0; i < search_cpus.size(); ++i) {
    threads_.emplace_back([=] { run(search_cpus[i], true, i); });
  }
  for (size_t i = 0; i < derivative_cpus.size(); ++i) {
    threads_.emplace_back([=] { run(derivative_cpus[i], false, i); });
  }
}

ThreadMatcher::~ThreadMatcher() {
  stop_ = true;
  ++pass_;
  announce(start_);
  for (std::thread & thread : threads_) {
    thread.join();
  }
}

void ThreadMatcher::put(const MapView & map, const float * xyz_m, size_t count) {
  const ScanView scan = lay_out_scan(xyz_m, count, scan_.with_room_for(scan_floats(count)));
  found_.resize(scan.groups * group_points);
  problem_ = {map, scan, options_, std::nullopt};
}

NewtonResult ThreadMatcher::align(
  const Levels & levels, const float * xyz_m, size_t count, const Pose6 & guess,
  const std::optional<Regularization> & regularization) {
  const Descent descent = descent_of(levels);
  put(descent.scored(), xyz_m, count);
  problem_.regularization = regularization;
  return descend(
    descent, problem_, guess, [&](const Problem &, const Pose6 & pose) { return run_pass(pose); });
}

Derivatives ThreadMatcher::evaluate(
  const Levels & levels, const float * xyz_m, size_t count, const Pose6 & pose) {
  put(descent_of(levels).scored(), xyz_m, count);
  return run_pass(pose);
}

Derivatives ThreadMatcher::run_pass(const Pose6 & pose) {
  pose_ = pass_pose(pose, *problem_.map.header);
  busy_ = static_cast<uint32_t>(threads_.size());
  ++pass_;
  announce(start_);
  wait_at(end_, [&] { return busy_ == 0; }, caller_spin_ns_);
  return finish_pass(problem_, add_bins(bins_), pose);
}

void ThreadMatcher::run(int cpu, bool is_search, size_t index) {
  pin_to_cpu(cpu);
  for (uint32_t seen = 0;; ++seen) {
    wait_at(start_, [&] { return pass_ != seen; }, thread_spin_ns);
    if (stop_) {
      return;
    }
    is_search ? search(index) : derive(index);
    if (--busy_ == 0) {
      announce(end_);
    }
  }
}

void ThreadMatcher::search(size_t index) {
  for (size_t bin = index; bin < bin_count; bin += search_threads_) {
    kernel_.search(problem_.map, problem_.scan, pose_, bin, found_.data());
    searched_[bin].store(pass_, std::memory_order_release);
  }
}

void ThreadMatcher::derive(size_t index) {
  const float d2 = kernel_d2(problem_);
  for (size_t bin = index; bin < bin_count; bin += derivative_threads_) {
    if (search_threads_ == 0) {
      bins_[bin] = kernel_.pass(problem_.map, problem_.scan, pose_, d2, bin);
      continue;
    }
    while (searched_[bin].load(std::memory_order_acquire) != pass_) {
      yield_cpu();
    }
    bins_[bin] = kernel_.derive(problem_.map, problem_.scan, pose_, d2, bin, found_.data());
  }
}

}  // namespace manycore::ndt
