// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// Branch and bound over places: bounds hold, nothing better is left out, and what is found does not
// depend on who works.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <thread>
#include <vector>

#include "ndt/search/place_search.hpp"

namespace manycore::ndt {
namespace {

constexpr double anywhere_m = std::numeric_limits<double>::infinity();
constexpr uint32_t yaws = 36;

/// Sloping ground of 60 m x 50 m with walls and posts at random places.
std::vector<double> random_town(uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> place(0, 50);
  std::normal_distribution<double> noise(0, 0.03);
  std::vector<double> xyz_m;
  const auto add = [&](double x, double y, double above) {
    const double ground = 0.1 * x - 3;
    xyz_m.insert(xyz_m.end(), {x + noise(random), y + noise(random), ground + above});
  };
  for (double x = 0; x < 60; x += 0.5) {
    for (double y = 0; y < 50; y += 0.5) {
      add(x, y, noise(random));
    }
  }
  for (int wall = 0; wall < 25; ++wall) {
    const double x = place(random);
    const double y = place(random);
    const double turn = place(random);
    for (double along = 0; along < 6; along += 0.3) {
      for (double z = 0; z < 5; z += 0.3) {
        add(x + along * std::cos(turn), y + along * std::sin(turn), z);
      }
    }
  }
  return xyz_m;
}

SearchMap search_map(uint32_t seed) {
  const std::vector<double> points = random_town(seed);
  const MapOptions options{2.0, Search::radius, VoxelCovariance::pcl, 6, 0.0};
  return build_search_map(build_voxel_map(points.data(), points.size() / 3, options));
}

/// What a sensor sees of a town from a place, without occlusion: level, z above the ground.
std::vector<float> seen_from(uint32_t seed, double x, double y, double yaw) {
  const std::vector<double> points = random_town(seed);
  std::vector<float> seen;
  for (size_t i = 0; i + 2 < points.size() && seen.size() < 900; i += 3 * 7) {
    const double dx = points[i] - x;
    const double dy = points[i + 1] - y;
    const double above = points[i + 2] - (0.1 * x - 3);
    if (std::hypot(dx, dy) < 30 && points[i + 2] - (0.1 * points[i] - 3) > 1) {
      seen.push_back(static_cast<float>(std::cos(yaw) * dx + std::sin(yaw) * dy));
      seen.push_back(static_cast<float>(std::cos(yaw) * dy - std::sin(yaw) * dx));
      seen.push_back(static_cast<float>(above));
    }
  }
  return seen;
}

uint32_t points_at(const SearchMap & map, const Sketch & sketch, const Node & node) {
  return points_at_something(map, sketch, node, map.floor(node.level, node.x, node.y), 0);
}

/// Maximum of the points of all places of a node that have ground.
uint32_t max_points(const SearchMap & map, const Sketch & sketch, const Node & node) {
  uint32_t max = 0;
  for (uint32_t y = node.y; y < node.y + (1U << node.level); ++y) {
    for (uint32_t x = node.x; x < node.x + (1U << node.level); ++x) {
      if (map.floor(0, x, y).is_known()) {
        max = std::max(max, points_at(map, sketch, {0, x, y, node.yaw}));
      }
    }
  }
  return max;
}

/// Maximum of the points of all places in some directions.
uint32_t max_points(
  const SearchMap & map, const std::vector<float> & scan, uint32_t first_yaw, uint32_t count) {
  const auto width = static_cast<uint32_t>(map.header().cells[0]);
  const auto depth = static_cast<uint32_t>(map.header().cells[1]);
  const Sketch sketch(scan.data(), scan.size() / 3, yaws, map.header().cells[0]);
  uint32_t max = 0;
  for (uint32_t i = 0; i < count; ++i) {
    for (uint32_t y = search_reach; y < depth - search_reach; y += root_cells) {
      for (uint32_t x = search_reach; x < width - search_reach; x += root_cells) {
        const Node root{root_level, x, y, (first_yaw + i) % yaws};
        max = std::max(max, max_points(map, sketch, root));
      }
    }
  }
  return max;
}

constexpr SearchOptions everywhere{yaws, 700, {0, 0}, anywhere_m, 0, yaws};

std::vector<FoundPlace> searched(
  const SearchMap & map, const std::vector<float> & scan, size_t workers,
  const SearchOptions & options = everywhere) {
  PlaceSearch search(map, scan.data(), scan.size() / 3, options);
  for (const SearchPhase phase : {SearchPhase::bound, SearchPhase::descend}) {
    std::vector<std::thread> threads;
    for (size_t i = 0; i < workers; ++i) {
      threads.emplace_back([&] { search.work(phase, [] { return false; }); });
    }
    for (std::thread & thread : threads) {
      thread.join();
    }
    CHECK(search.is_done());
    if (phase == SearchPhase::bound) {
      search.order_roots();
    }
  }
  return search.found(100);
}

}  // namespace

static bool operator==(const FoundPlace & a, const FoundPlace & b) {
  return a.x_m == b.x_m && a.y_m == b.y_m && a.ground_m == b.ground_m && a.yaw_rad == b.yaw_rad &&
         a.points == b.points;
}

TEST_CASE("the bound of a node is an upper bound of all its places and all its quarters") {
  for (const uint32_t seed : {1, 2, 3}) {
    const SearchMap map = search_map(seed);
    const std::vector<float> scan = seen_from(seed, 20, 20, 0.3);
    const auto width = static_cast<uint32_t>(map.header().cells[0]);
    const auto depth = static_cast<uint32_t>(map.header().cells[1]);
    const Sketch sketch(scan.data(), scan.size() / 3, yaws, static_cast<int32_t>(width));
    std::mt19937 generator(seed);
    const auto random = [&] { return static_cast<uint32_t>(generator()); };
    size_t checked = 0;
    for (uint32_t level = 1; level <= root_level; ++level) {
      for (uint32_t i = 0; i < 200; ++i) {
        const uint32_t x = search_reach + random() % (width - 2 * search_reach);
        const uint32_t y = search_reach + random() % (depth - 2 * search_reach);
        const Node node{level, x >> level << level, y >> level << level, random() % yaws};
        if (map.floor(level, node.x, node.y).is_known()) {
          const uint32_t bound = points_at(map, sketch, node);
          CHECK(bound >= max_points(map, sketch, node));
          for (const uint32_t quarter : {0, 1, 2, 3}) {
            const uint32_t half = 1U << (level - 1);
            const Node part{
              level - 1, node.x + (quarter & 1) * half, node.y + (quarter >> 1) * half, node.yaw};
            CHECK(
              (!map.floor(part.level, part.x, part.y).is_known() ||
               bound >= points_at(map, sketch, part)));
          }
          checked += bound > 0;
        }
      }
    }
    CHECK(checked > 500);
  }
}

TEST_CASE("the best of all places is found, whoever does the work") {
  const SearchMap map = search_map(4);
  const std::vector<float> scan = seen_from(4, 25, 30, 1.0);
  const std::vector<FoundPlace> found = searched(map, scan, 1);
  REQUIRE(!found.empty());
  CHECK(std::hypot(found[0].x_m - 25, found[0].y_m - 30) < 1.5);
  CHECK(std::abs(found[0].yaw_rad - 1.0) < 0.2);

  CHECK(found[0].points == max_points(map, scan, 0, yaws));

  for (const size_t workers : {2, 3, 5}) {
    CHECK(searched(map, scan, workers) == found);
  }
}

TEST_CASE("a search goes on where it was interrupted") {
  const SearchMap map = search_map(5);
  const std::vector<float> scan = seen_from(5, 30, 20, 2.0);
  PlaceSearch search(map, scan.data(), scan.size() / 3, everywhere);
  for (const SearchPhase phase : {SearchPhase::bound, SearchPhase::descend}) {
    for (size_t slices = 0; !search.is_done(); ++slices) {
      REQUIRE(slices < 100'000);
      size_t asked = 0;
      search.work(phase, [&] { return asked++ > 0; });
    }
    if (phase == SearchPhase::bound) {
      search.order_roots();
    }
  }
  CHECK(search.found(100) == searched(map, scan, 2));
}

TEST_CASE("only the places within the radius are searched") {
  const SearchMap map = search_map(6);
  const std::vector<float> scan = seen_from(6, 45, 10, 0.5);
  constexpr double radius_m = 5;
  const std::vector<FoundPlace> found =
    searched(map, scan, 1, {yaws, 1, {10, 40}, radius_m, 0, yaws});
  REQUIRE(!found.empty());
  for (const FoundPlace & place : found) {  // a column at the edge is searched
    CHECK(std::hypot(place.x_m - 10, place.y_m - 40) < radius_m + 0.7072 * search_cell_m);
  }
}

TEST_CASE("places of other directions do not keep those that are searched from being found") {
  const SearchMap map = search_map(7);
  const std::vector<float> scan = seen_from(7, 25, 20, 0.1);
  constexpr uint32_t first_yaw = 32;
  constexpr uint32_t count = 2;
  constexpr double per_yaw_rad = turn_rad / yaws;
  const std::vector<FoundPlace> found =
    searched(map, scan, 2, {yaws, 850, {0, 0}, anywhere_m, first_yaw, count});
  REQUIRE(!found.empty());
  const uint32_t max = max_points(map, scan, first_yaw, count);
  CHECK(found[0].points == max);
  CHECK(max < max_points(map, scan, 0, yaws) * 850 / 1000);  // else nothing is shown
  for (const FoundPlace & place : found) {
    CHECK(place.yaw_rad > (first_yaw - 0.5) * per_yaw_rad);
    CHECK(place.yaw_rad < (first_yaw + count - 0.5) * per_yaw_rad);
  }
  const std::vector<FoundPlace> over_zero =
    searched(map, scan, 2, {yaws, 850, {0, 0}, anywhere_m, 30, 10});
  CHECK(over_zero[0].points == max_points(map, scan, 30, 10));
}

TEST_CASE("roots with high bounds come first, and of equal ones those with low numbers") {
  const SearchMap map = search_map(8);
  const std::vector<float> scan = seen_from(8, 20, 30, 1.5);
  PlaceSearch search(map, scan.data(), scan.size() / 3, everywhere);
  search.work(SearchPhase::bound, [] { return false; });
  search.order_roots();
  const SearchHead & h = search.head();
  const auto * const bounds = &search.memory().at<const uint16_t>(h.at.bounds);
  const auto * const order = &search.memory().at<const uint32_t>(h.at.order);
  std::vector<uint32_t> expected(search.roots());
  std::iota(expected.begin(), expected.end(), 0U);
  std::stable_sort(expected.begin(), expected.end(), [bounds](uint32_t a, uint32_t b) {
    return bounds[a] > bounds[b];
  });
  CHECK(std::equal(expected.begin(), expected.end(), order));
  CHECK(bounds[order[0]] > bounds[order[search.roots() - 1]]);
}

TEST_CASE("the memory of a search is known before it is laid out") {
  const std::vector<double> town = random_town(9);
  const MapOptions options{2.0, Search::radius, VoxelCovariance::pcl, 6, 0.0};
  const VoxelMap voxels = build_voxel_map(town.data(), town.size() / 3, options);
  const SearchMap map = build_search_map(voxels);
  CHECK(search_map_bytes(voxels) == map.header().size_bytes);
  const std::vector<float> scan = seen_from(9, 20, 30, 1.5);
  const size_t points = scan.size() / 3;
  const PlaceSearch search(map, scan.data(), points, everywhere);
  CHECK(search_bytes(map, points, everywhere) == search.head().at.size_bytes);
}

}  // namespace manycore::ndt
