// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// Compares the kernels of all instruction sets with the portable one, at the sizes where groups and
// bins begin and end, and tests parts with known answers. Sanitizers check here what Python tests
// cannot.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <random>
#include <thread>
#include <vector>

#include "ndt/common/aligned_floats.hpp"
#include "ndt/map/table.hpp"
#include "ndt/matching/matcher.hpp"
#include "ndt/matching/worker_session.hpp"
#include "ndt/optimisation/more_thuente.hpp"

namespace manycore::ndt {
namespace {

/// Noisy ground with steps, 40 m x 40 m.
std::vector<double> ground() {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, 0.05);
  std::vector<double> xyz_m;
  for (double x = -20; x < 20; x += 0.25) {
    for (double y = -20; y < 20; y += 0.25) {
      const double z = x > 3 ? 1.5 : 0;
      xyz_m.insert(xyz_m.end(), {x + noise(random), y + noise(random), z + noise(random)});
    }
  }
  return xyz_m;
}

std::vector<float> scan_of(size_t points) {
  std::mt19937 random(9);
  std::uniform_real_distribution<float> place(-25, 25);
  std::vector<float> xyz_m;
  for (size_t i = 0; i < 3 * points; ++i) {
    xyz_m.push_back(i % 3 == 2 ? place(random) / 20 : place(random));
  }
  return xyz_m;
}

std::vector<Simd> kinds() {
  std::vector<Simd> found;
  for (const Simd simd : {Simd::portable, Simd::avx2, Simd::avx512}) {
    if (simd <= choose_simd()) {
      found.push_back(simd);
    }
  }
  return found;
}

MapOptions map_options(Search search) { return {2.0, search, VoxelCovariance::autoware, 6, 0.0}; }

const MatchOptions match_options{StepRule::trust_region, 30, 0.1, 0.01, 0.55, 0.0};
const Pose6 pose{0.3, -0.2, 0.1, 0.02, -0.03, 0.4};

}  // namespace

TEST_CASE("all instruction sets compute the same sums, whatever the size of the scan") {
  const std::vector<double> points = ground();
  for (const Search search : {Search::radius, Search::direct7, Search::direct1}) {
    const VoxelMap map = build_voxel_map(points.data(), points.size() / 3, map_options(search));
    for (const size_t count : {0, 1, 15, 16, 17, 1535, 1536, 1537, 60000}) {
      const std::vector<float> scan = scan_of(count);
      AlignedFloats floats;
      const ScanView view =
        lay_out_scan(scan.data(), count, floats.with_room_for(scan_floats(count)));
      const Problem problem{map.view(), view, match_options, {}};
      const Derivatives expected = evaluate_alone(problem, kernel_portable(), pose);
      for (const Simd simd : kinds()) {
        const Derivatives found = evaluate_alone(problem, kernel_of(simd), pose);
        CHECK(found.pairs == expected.pairs);
        CHECK(found.points == expected.points);
        CHECK(found.scan_points == count);
        CHECK(found.score == doctest::Approx(expected.score).epsilon(1e-5));
        for (size_t i = 0; i < 6; ++i) {
          CHECK(found.hessian[i][i] == doctest::Approx(expected.hessian[i][i]).epsilon(1e-3));
        }
      }
    }
  }
}

TEST_CASE("a thinned scan has the sums of groups of points spread over it") {
  const std::vector<double> points = ground();
  const VoxelMap map =
    build_voxel_map(points.data(), points.size() / 3, map_options(Search::radius));
  for (const size_t count : {0, 16, 1999, 4000, 4001, 23457}) {
    const std::vector<float> scan = scan_of(count);
    AlignedFloats floats;
    const ScanView whole =
      lay_out_scan(scan.data(), count, floats.with_room_for(scan_floats(count)));
    const ScanView few = thinned(whole, 2000);
    CHECK(few.is_thinned() == (count >= 4000));
    CHECK(few.used == (few.is_thinned() ? 2000 / group_points : whole.groups));
    std::vector<float> kept;
    for (size_t number = 0; number < few.used; ++number) {
      const size_t first = number * whole.groups / few.used * group_points;
      for (size_t i = first; i < std::min(first + group_points, whole.points); ++i) {
        kept.insert(kept.end(), {whole.x_m[i], whole.y_m[i], whole.z_m[i]});
      }
    }
    CHECK(few.points == kept.size() / 3);
    AlignedFloats others;
    const ScanView alone =
      lay_out_scan(kept.data(), few.points, others.with_room_for(scan_floats(few.points)));
    for (const Simd simd : kinds()) {
      const Kernel kernel = kernel_of(simd);
      const Problem problem{map.view(), few, match_options, {}};
      const Derivatives found = evaluate_alone(problem, kernel, pose);
      const Derivatives expected =
        evaluate_alone({map.view(), alone, match_options, {}}, kernel, pose);
      CHECK(found.points == expected.points);
      CHECK(found.scan_points == few.points);
      CHECK(found.score == doctest::Approx(expected.score).epsilon(1e-5));
    }
  }
}

TEST_CASE("separate search and derivatives equal the combined pass") {
  const std::vector<double> points = ground();
  const VoxelMap map =
    build_voxel_map(points.data(), points.size() / 3, map_options(Search::direct7));
  const std::vector<float> scan = scan_of(5000);
  AlignedFloats floats;
  const ScanView view = lay_out_scan(scan.data(), 5000, floats.with_room_for(scan_floats(5000)));
  std::vector<uint32_t> found(view.groups * group_points);
  const PassPose at = pass_pose(pose, map.header());
  for (const Simd simd : kinds()) {
    const Kernel kernel = kernel_of(simd);
    for (size_t bin = 0; bin < bin_count; ++bin) {
      kernel.search(map.view(), view, at, bin, found.data());
      const TangentSums apart = kernel.derive(map.view(), view, at, 0.1F, bin, found.data());
      const TangentSums whole = kernel.pass(map.view(), view, at, 0.1F, bin);
      CHECK(std::equal(apart.of, apart.of + sum_count, whole.of));
    }
  }
}

TEST_CASE("cells without voxels in range have the empty list") {
  const std::vector<double> points = ground();
  const VoxelMap map =
    build_voxel_map(points.data(), points.size() / 3, map_options(Search::direct7));
  CHECK(find_list(map.view(), 0) == empty_list);
  CHECK(map.view().lists[empty_list] == 0);
}

TEST_CASE("each bin of a pass is begun once, by any worker") {
  constexpr size_t workers = 3;
  constexpr uint32_t passes = 200;
  std::array<Share, workers> shares{};
  std::array<std::atomic<uint32_t>, bin_count> begun{};
  const auto work = [&](size_t index, uint64_t ticket) {
    for (size_t i = 0; i < workers; ++i) {
      const size_t owner = (index + i) % workers;
      while (const auto bin = shares[owner].begin(ticket, owner, workers)) {
        ++begun[*bin];
      }
    }
  };
  for (uint32_t pass = 1; pass <= passes; ++pass) {
    std::thread other(work, 0, ticket_of(7, pass));
    work(1, ticket_of(7, pass));  // worker 2 is missing: its share is done anyway
    other.join();
    CHECK(std::all_of(begun.begin(), begun.end(), [&](uint32_t times) { return times == pass; }));
  }
}

TEST_CASE("eigenvalues and eigenvectors reproduce the matrix") {
  const Matrix3 matrix{{{4, 1, -2}, {1, 2, 0}, {-2, 0, 3}}};
  const Matrix3 again = symmetric_eigen(matrix).map([](double value) { return value; });
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = 0; j < 3; ++j) {
      CHECK(again[i][j] == doctest::Approx(matrix[i][j]));
    }
  }
}

TEST_CASE("the line search approaches the minimum of a parabola") {
  const auto parabola = [](double x) { return LinePoint{x, (x - 2) * (x - 2), 2 * (x - 2)}; };
  CHECK(more_thuente(parabola(0), 4.5, 0.01, 5, parabola) == doctest::Approx(2).epsilon(0.5));
}

}  // namespace manycore::ndt
