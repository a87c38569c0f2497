// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "ndt/search/search_map.hpp"
#include "ndt/search/sketch.hpp"
#include "platform/shared_memory.hpp"

namespace manycore::ndt {

constexpr size_t max_sketch_points = 4096;

/// What is searched. No default values: these are in place_search.py.
struct SearchOptions {
  uint32_t yaws;           ///< directions that are compared
  uint32_t kept_permille;  ///< places with fewer of the best one's points are not kept
  double centre_m[2];      ///< of the places
  double radius_m;         ///< of the places, with the columns that it touches; infinity: all
  uint32_t first_yaw;      ///< first of the directions that are searched
  uint32_t searched_yaws;  ///< number of these, from the first on; yaws: all
};

/// Bytes of a search for `count` points, before it is laid out.
uint64_t search_bytes(const SearchMap & map, size_t count, const SearchOptions & options);

/// A place that stands out from those around it.
struct FoundPlace {
  double x_m;
  double y_m;
  double ground_m;  ///< its height
  double yaw_rad;
  uint32_t points;  ///< of the sketch that are at something
};

enum class SearchPhase : uint32_t { bound, descend };

/// Where the parts of a search's memory begin [bytes], and its size.
struct SearchParts {
  uint64_t points;
  uint64_t squares;
  uint64_t bounds;
  uint64_t order;
  uint64_t tiles;
  uint64_t size_bytes;
};

/// Head of a search's memory. Processes that share the memory share the work.
struct SearchHead {
  uint64_t id;  ///< unique in the process that laid it out
  uint32_t points;
  SearchOptions options;
  uint32_t squares;  ///< nodes of the root level that have ground, in one direction
  SearchParts at;
  alignas(64) std::atomic<uint32_t> next;  ///< first root that is not begun
  alignas(64) std::atomic<uint32_t> best;  ///< points of the best place so far
};

/// A search by branch and bound: quarters squares of places whose upper bound is high enough. The
/// result does not depend on how the work is split or timed.
///
/// Of each tile of 4 by 4 places and a sixteenth of the directions the best place is kept. Squares
/// are left out whose bound is below that of their tile, or below the kept share of the best one.
class PlaceSearch {
public:
  /// Lays out a search for level points: x, y from the sensor on, z above the ground [m].
  PlaceSearch(
    const SearchMap & map, const float * xyz_m, size_t count, const SearchOptions & options);
  /// Takes part in a search whose memory another process has laid out.
  PlaceSearch(const SearchMap & map, SharedMemory memory);

  const SearchMap & map() const noexcept { return map_; }
  const SharedMemory & memory() const noexcept { return memory_; }
  SearchHead & head() const noexcept { return memory_.at<SearchHead>(0); }
  uint32_t roots() const noexcept { return head().squares * head().options.searched_yaws; }

  /// Works on the next roots until all are begun or `is_due` holds.
  void work(SearchPhase phase, const std::function<bool()> & is_due);
  /// True if nothing of the phase is left to be begun.
  bool is_done() const noexcept;
  /// Sorts the roots by their bounds, between the phases.
  void order_roots();
  /// At most `limit` places, best first, of which none is near a better one.
  std::vector<FoundPlace> found(size_t limit) const;

private:
  Node root(uint32_t index) const noexcept;
  uint32_t bound(const Node & node) const noexcept;
  void descend(const Node & node);
  void keep(const Node & place, uint32_t points) noexcept;
  /// Fewest points of places that are worth a look.
  uint32_t kept_points() const noexcept;
  uint32_t needed(const Node & node) const noexcept;
  std::atomic<uint64_t> & tile(const Node & node) const noexcept;
  FoundPlace place_of(uint64_t kept) const;

  const SearchMap & map_;
  SharedMemory memory_;
  Sketch sketch_;
};

}  // namespace manycore::ndt
