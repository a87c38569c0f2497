// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "bench/ndt/profiler.hpp"

#include "platform/clock.hpp"

namespace manycore::ndt {
namespace {

template<typename F>
double time_ns(F && f) {
  const int64_t start_ns = monotonic_ns();
  f();
  return static_cast<double>(monotonic_ns() - start_ns);
}

}  // namespace

Problem Profiler::problem(const VoxelMap & map, const float * xyz_m, size_t count) {
  const ScanView scan = lay_out_scan(xyz_m, count, scan_.with_room_for(scan_floats(count)));
  return {map.view(), scan, options_, std::nullopt};
}

std::vector<double> Profiler::time_passes_ns(
  const VoxelMap & map, const float * xyz_m, size_t count, const Pose6 & pose, size_t passes) {
  const Problem matched = problem(map, xyz_m, count);
  std::vector<double> times_ns;
  for (size_t i = 0; i < passes; ++i) {
    times_ns.push_back(time_ns([&] { evaluate_alone(matched, kernel_, pose); }));
  }
  return times_ns;
}

std::vector<double> Profiler::time_shares_ns(
  const VoxelMap & map, const float * xyz_m, size_t count, const Pose6 & pose, size_t workers) {
  const Problem matched = problem(map, xyz_m, count);
  const PassPose at = pass_pose(pose, map.header());
  const float d2 = kernel_d2(matched);
  evaluate_alone(matched, kernel_, pose);  // warms the caches for the first share
  std::vector<double> times_ns;
  for (size_t worker = 0; worker < workers; ++worker) {
    times_ns.push_back(time_ns([&] {
      for (size_t bin = worker; bin < bin_count; bin += workers) {
        kernel_.pass(matched.map, matched.scan, at, d2, bin);
      }
    }));
  }
  return times_ns;
}

Profile Profiler::profile(
  const VoxelMap & map, const float * xyz_m, size_t count, const Pose6 & guess) {
  Profile times{};
  times.total_ns = time_ns([&] {
    Problem matched{};
    times.lay_out_ns = time_ns([&] { matched = problem(map, xyz_m, count); });
    std::vector<uint32_t> found(matched.scan.groups * group_points);
    const float d2 = kernel_d2(matched);
    maximise(guess, options_, [&](const Pose6 & pose) {
      const PassPose at = pass_pose(pose, *matched.map.header);
      TangentSums bins[bin_count];
      times.search_ns += time_ns([&] {
        for (size_t bin = 0; bin < bin_count; ++bin) {
          kernel_.search(matched.map, matched.scan, at, bin, found.data());
        }
      });
      times.derivatives_ns += time_ns([&] {
        for (size_t bin = 0; bin < bin_count; ++bin) {
          bins[bin] = kernel_.derive(matched.map, matched.scan, at, d2, bin, found.data());
        }
      });
      return finish_pass(matched, add_bins(bins), pose);
    });
  });
  return times;
}

}  // namespace manycore::ndt
