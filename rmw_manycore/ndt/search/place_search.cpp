// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "ndt/search/place_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <string>
#include <utility>

#include "ndt/common/alignment.hpp"
#include "platform/error.hpp"

namespace manycore::ndt {
namespace {

constexpr uint32_t tile_level = 2;
constexpr uint32_t sectors = 16;
constexpr uint32_t roots_at_once = 32;
/// Places nearer than this, in about the same direction, are one.
constexpr double same_m = 3;
constexpr double same_rad = 0.3;

struct Square {
  uint16_t x;  ///< in squares
  uint16_t y;
};

/// Whether a node has ground, and the circle that is searched touches its square.
bool is_searched(
  const SearchMap & map, const SearchOptions & options, uint32_t level, uint32_t x, uint32_t y) {
  const uint32_t cells = 1U << level;
  const double away_m = std::hypot(
    map.middle_m(0, x, cells) - options.centre_m[0],
    map.middle_m(1, y, cells) - options.centre_m[1]);
  const double half_diagonal_m = 0.7072 * cells * search_cell_m;
  return map.floor(level, x, y).is_known() && away_m <= options.radius_m + half_diagonal_m;
}

/// Squares of the root level that are searched.
std::vector<Square> squares_of(const SearchMap & map, const SearchOptions & options) {
  std::vector<Square> squares;
  const SearchMapHeader & h = map.header();
  for (uint32_t y = 0; y < static_cast<uint32_t>(h.cells[1]); y += root_cells) {
    for (uint32_t x = 0; x < static_cast<uint32_t>(h.cells[0]); x += root_cells) {
      if (is_searched(map, options, root_level, x, y)) {
        squares.push_back(
          {static_cast<uint16_t>(x / root_cells), static_cast<uint16_t>(y / root_cells)});
      }
    }
  }
  return squares;
}

double apart_rad(double a, double b) { return std::abs(std::remainder(a - b, turn_rad)); }

bool is_same(const FoundPlace & a, const FoundPlace & b) {
  return std::hypot(a.x_m - b.x_m, a.y_m - b.y_m) < same_m &&
         apart_rad(a.yaw_rad, b.yaw_rad) < same_rad;
}

/// A tile's best place: more points first, and of as many the one with the lowest number.
constexpr uint32_t number_bits = 48;
constexpr uint64_t number_mask = (uint64_t{1} << number_bits) - 1;

uint64_t kept_of(uint32_t points, uint64_t number) {
  return uint64_t{points} << number_bits | (number_mask - number);
}
uint32_t points_of(uint64_t kept) { return static_cast<uint32_t>(kept >> number_bits); }

template<typename T>
void raise_to(std::atomic<T> & word, T value) noexcept {
  T seen = word.load(std::memory_order_relaxed);
  while (seen < value && !word.compare_exchange_weak(seen, value, std::memory_order_relaxed)) {
  }
}

uint64_t tile_count(const SearchMap & map) {
  const SearchMapHeader & h = map.header();
  return (static_cast<uint64_t>(h.cells[0]) >> tile_level) *
         (static_cast<uint64_t>(h.cells[1]) >> tile_level) * sectors;
}

SearchParts parts_of(
  const SearchMap & map, size_t count, size_t squares, const SearchOptions & options) {
  const uint64_t roots = squares * options.searched_yaws;
  SearchParts at{};
  at.points = align_up(sizeof(SearchHead));
  at.squares = align_up(at.points + 3 * count * sizeof(float));
  at.bounds = align_up(at.squares + squares * sizeof(Square));
  at.order = align_up(at.bounds + roots * sizeof(uint16_t));
  at.tiles = align_up(at.order + roots * sizeof(uint32_t));
  at.size_bytes = at.tiles + tile_count(map) * sizeof(uint64_t);
  return at;
}

SharedMemory laid_out(
  const SearchMap & map, const float * xyz_m, size_t count, const SearchOptions & options) {
  const bool is_turn = options.searched_yaws > 0 && options.searched_yaws <= options.yaws;
  if (count > max_sketch_points || !is_turn || options.kept_permille == 0) {
    throw Error(ErrorCode::invalid_argument, "search: too many points, or no direction");
  }
  const std::vector<Square> squares = squares_of(map, options);
  const SearchParts at = parts_of(map, count, squares.size(), options);
  SharedMemory memory = SharedMemory::anonymous("manycore-ndt-search", at.size_bytes);
  auto & h = memory.at<SearchHead>(0);
  static std::atomic<uint64_t> searches{0};
  h.id = ++searches;
  h.points = static_cast<uint32_t>(count);
  h.options = options;
  h.squares = static_cast<uint32_t>(squares.size());
  h.at = at;
  std::copy_n(xyz_m, 3 * count, &memory.at<float>(at.points));
  std::copy(squares.begin(), squares.end(), &memory.at<Square>(at.squares));
  return memory;
}

}  // namespace

uint64_t search_bytes(const SearchMap & map, size_t count, const SearchOptions & options) {
  return parts_of(map, count, squares_of(map, options).size(), options).size_bytes;
}

PlaceSearch::PlaceSearch(
  const SearchMap & map, const float * xyz_m, size_t count, const SearchOptions & options)
: PlaceSearch(map, laid_out(map, xyz_m, count, options)) {}

PlaceSearch::PlaceSearch(const SearchMap & map, SharedMemory memory)
: map_(map),
  memory_(std::move(memory)),
  sketch_(
    &memory_.at<float>(head().at.points), head().points, head().options.yaws,
    map.header().cells[0]) {}

void PlaceSearch::work(SearchPhase phase, const std::function<bool()> & is_due) {
  SearchHead & h = head();
  auto * const bounds = &memory_.at<uint16_t>(h.at.bounds);
  const auto * const order = &memory_.at<const uint32_t>(h.at.order);
  while (!is_due()) {
    const uint32_t begin = h.next.fetch_add(roots_at_once, std::memory_order_relaxed);
    if (begin >= roots()) {
      h.next.store(roots(), std::memory_order_relaxed);
      return;
    }
    const uint32_t end = std::min(begin + roots_at_once, roots());
    for (uint32_t i = begin; i < end; ++i) {
      if (phase == SearchPhase::bound) {
        bounds[i] = static_cast<uint16_t>(bound(root(i)));
      } else if (bounds[order[i]] >= kept_points()) {
        descend(root(order[i]));
      }
    }
  }
}

bool PlaceSearch::is_done() const noexcept {
  return head().next.load(std::memory_order_relaxed) >= roots();
}

void PlaceSearch::order_roots() {
  SearchHead & h = head();
  const auto * const bounds = &memory_.at<const uint16_t>(h.at.bounds);
  auto * const order = &memory_.at<uint32_t>(h.at.order);
  std::vector<uint32_t> begin(h.points + 2);  // of the roots of each number of missed points
  for (uint32_t i = 0; i < roots(); ++i) {
    ++begin[h.points - bounds[i] + 1];
  }
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  for (uint32_t i = 0; i < roots(); ++i) {
    order[begin[h.points - bounds[i]]++] = i;
  }
  h.next.store(0, std::memory_order_relaxed);
}

Node PlaceSearch::root(uint32_t index) const noexcept {
  const SearchHead & h = head();
  const SearchOptions & o = h.options;
  const Square square = (&memory_.at<const Square>(h.at.squares))[index / o.searched_yaws];
  const uint32_t yaw = (o.first_yaw + index % o.searched_yaws) % o.yaws;
  return {root_level, square.x * root_cells, square.y * root_cells, yaw};
}

uint32_t PlaceSearch::bound(const Node & node) const noexcept {
  const Floor floor = map_.floor(node.level, node.x, node.y);
  return points_at_something(map_, sketch_, node, floor, needed(node));
}

void PlaceSearch::descend(const Node & node) {
  const uint32_t level = node.level - 1;
  std::array<Node, 4> quarters{};
  std::array<uint32_t, 4> bounds{};  // 0: done, or not worth it
  for (uint32_t i = 0; i < quarters.size(); ++i) {
    quarters[i] = {level, node.x + ((i & 1) << level), node.y + ((i >> 1) << level), node.yaw};
    if (!is_searched(map_, head().options, level, quarters[i].x, quarters[i].y)) {
      continue;
    }
    bounds[i] = bound(quarters[i]);
    if (level == 0) {
      keep(quarters[i], bounds[i]);
    }
  }
  while (level > 0) {  // the most promising quarter first
    const auto i =
      static_cast<size_t>(std::max_element(bounds.begin(), bounds.end()) - bounds.begin());
    if (bounds[i] < kept_points()) {
      return;
    }
    if (std::exchange(bounds[i], 0) >= needed(quarters[i])) {
      descend(quarters[i]);
    }
  }
}

void PlaceSearch::keep(const Node & place, uint32_t points) noexcept {
  if (points < needed(place)) {
    return;
  }
  const auto width = static_cast<uint64_t>(map_.header().cells[0]);
  const auto depth = static_cast<uint64_t>(map_.header().cells[1]);
  raise_to(tile(place), kept_of(points, (place.yaw * depth + place.y) * width + place.x));
  raise_to(head().best, points);
}

uint32_t PlaceSearch::kept_points() const noexcept {
  const SearchHead & h = head();
  return std::max(
    1U, (h.best.load(std::memory_order_relaxed) * h.options.kept_permille + 999) / 1000);
}

uint32_t PlaceSearch::needed(const Node & node) const noexcept {
  if (node.level > tile_level) {
    return kept_points();
  }
  return std::max(kept_points(), points_of(tile(node).load(std::memory_order_relaxed)));
}

std::atomic<uint64_t> & PlaceSearch::tile(const Node & node) const noexcept {
  const SearchHead & h = head();
  const uint64_t wide = static_cast<uint64_t>(map_.header().cells[0]) >> tile_level;
  const uint64_t index = (node.y >> tile_level) * wide + (node.x >> tile_level);
  const uint64_t sector = node.yaw * sectors / h.options.yaws;
  return (&memory_.at<std::atomic<uint64_t>>(h.at.tiles))[index * sectors + sector];
}

std::vector<FoundPlace> PlaceSearch::found(size_t limit) const {
  std::vector<uint64_t> kept;
  const auto * const tiles = &memory_.at<const std::atomic<uint64_t>>(head().at.tiles);
  for (uint64_t i = 0; i < tile_count(map_); ++i) {
    const uint64_t one = tiles[i].load(std::memory_order_relaxed);
    if (points_of(one) >= kept_points()) {
      kept.push_back(one);
    }
  }
  std::sort(kept.begin(), kept.end(), std::greater<>());
  std::vector<FoundPlace> places;
  for (size_t i = 0; i < kept.size() && places.size() < limit; ++i) {
    const FoundPlace place = place_of(kept[i]);
    if (std::none_of(places.begin(), places.end(), [&place](const FoundPlace & better) {
          return is_same(place, better);
        })) {
      places.push_back(place);
    }
  }
  return places;
}

FoundPlace PlaceSearch::place_of(uint64_t kept) const {
  const SearchMapHeader & h = map_.header();
  const auto width = static_cast<uint64_t>(h.cells[0]);
  const auto depth = static_cast<uint64_t>(h.cells[1]);
  const uint64_t number = number_mask - (kept & number_mask);
  const auto x = static_cast<uint32_t>(number % width);
  const auto y = static_cast<uint32_t>(number / width % depth);
  const auto yaw = static_cast<double>(number / width / depth);
  return {
    map_.middle_m(0, x, 1), map_.middle_m(1, y, 1), map_.ground_m(x, y),
    turn_rad * yaw / head().options.yaws, points_of(kept)};
}

}  // namespace manycore::ndt
