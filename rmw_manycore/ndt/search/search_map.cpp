// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "ndt/search/search_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "ndt/common/alignment.hpp"
#include "ndt/common/matrix.hpp"
#include "platform/error.hpp"

namespace manycore::ndt {
namespace {

/// Standard deviations from a voxel's mean up to which its cells are occupied, after widening: the
/// places that are compared are a cell apart, so a scan is up to half a cell off.
constexpr double reach_deviations = 1.75;
constexpr double widening_cells = 0.4;
constexpr uint64_t max_columns = uint64_t{1} << 26;
constexpr float no_ground = std::numeric_limits<float>::infinity();

int32_t cell_of(double place_m) {
  return static_cast<int32_t>(std::floor(place_m / search_cell_m));
}

/// Inverse of a symmetric matrix, by cofactors: exact enough, as a voxel's eigenvalues differ by a
/// factor of 100 at most.
Matrix3 inverse_of(const Matrix3 & a) {
  const auto cofactor = [&a](size_t i, size_t j) {
    const size_t k = (i + 1) % 3;
    const size_t l = (i + 2) % 3;
    const size_t m = (j + 1) % 3;
    const size_t n = (j + 2) % 3;
    return a[k][m] * a[l][n] - a[k][n] * a[l][m];
  };
  Matrix3 out{};
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = 0; j < 3; ++j) {
      out[i][j] = cofactor(i, j);
    }
  }
  const double determinant = dot(a[0], out[0]);
  for (Vector3 & row : out) {
    for (double & element : row) {
      element /= determinant;
    }
  }
  return out;
}

/// A voxel's mean [m, map frame] and covariance, widened.
struct Spread {
  Vector3 mean_m;
  Matrix3 inverse;
  Vector3 reach_m;  ///< half of the box around the cells it occupies
};

Spread spread_of(const MapHeader & map, const VoxelLine & line) {
  const float * const b = line.inverse_covariance;
  const auto at = [b](size_t i) { return static_cast<double>(b[i]); };
  constexpr double widening_m = widening_cells * search_cell_m;
  Matrix3 covariance =
    inverse_of({{{at(0), at(1), at(2)}, {at(1), at(3), at(4)}, {at(2), at(4), at(5)}}});
  for (size_t i = 0; i < 3; ++i) {
    covariance[i][i] += widening_m * widening_m;
  }
  Spread spread{{}, inverse_of(covariance), {}};
  for (size_t i = 0; i < 3; ++i) {
    spread.mean_m[i] = static_cast<double>(line.mean_m[i]) + map.origin_m[i];
    spread.reach_m[i] = reach_deviations * std::sqrt(covariance[i][i]);
  }
  return spread;
}

using Cell3 = std::array<int32_t, 3>;

/// Fills a search map whose memory is laid out and zero.
class Builder {
public:
  Builder(const VoxelMap & map, const SearchMapHeader & header, SharedMemory & memory)
  : map_(map),
    header_(header),
    columns_(&memory.at<uint64_t>(header.columns_offset)),
    ground_(&memory.at<float>(header.ground_offset)),
    memory_(memory) {}

  void build() {
    std::fill(ground_, ground_ + count(), no_ground);
    const MapView view = map_.view();
    for (uint32_t i = 1; i <= view.header->voxel_count; ++i) {
      const Spread spread = spread_of(*view.header, view.lines[i]);
      occupy(spread);
      lower_ground(spread);
    }
    for (uint32_t level = 0; level + 1 < search_levels; ++level) {
      unite(level);
    }
    settle_floors();
  }

private:
  size_t count() const {
    return static_cast<size_t>(header_.cells[0]) * static_cast<size_t>(header_.cells[1]);
  }
  size_t index(int32_t x, int32_t y) const {
    return static_cast<size_t>(y) * static_cast<size_t>(header_.cells[0]) + static_cast<size_t>(x);
  }

  void occupy(const Spread & s) {
    std::array<int32_t, 3> low{};
    std::array<int32_t, 3> high{};
    for (size_t i = 0; i < 3; ++i) {
      low[i] = cell_of(s.mean_m[i] - s.reach_m[i]);
      high[i] = cell_of(s.mean_m[i] + s.reach_m[i]);
    }
    Cell3 cell{};
    for (cell[1] = low[1]; cell[1] <= high[1]; ++cell[1]) {
      for (cell[0] = low[0]; cell[0] <= high[0]; ++cell[0]) {
        for (cell[2] = low[2]; cell[2] <= high[2]; ++cell[2]) {
          if (is_in(s, cell)) {
            set(cell);
          }
        }
      }
    }
  }

  static bool is_in(const Spread & s, const Cell3 & cell) {
    Vector3 x{};
    for (size_t i = 0; i < 3; ++i) {
      x[i] = (cell[i] + 0.5) * search_cell_m - s.mean_m[i];
    }
    return dot(x, s.inverse * x) <= reach_deviations * reach_deviations;
  }

  void set(const Cell3 & cell) {
    const int32_t x = cell[0] - header_.first_cell[0];
    const int32_t y = cell[1] - header_.first_cell[1];
    if (is_inside(x, y)) {
      columns_[index(x, y)] |= uint64_t{1} << (static_cast<uint32_t>(cell[2]) % 64);
    }
  }

  /// The ground of a column is the lowest voxel around it: the vehicle may hide what is below it.
  void lower_ground(const Spread & s) {
    const double size_m = map_.header().voxel_size_m;
    std::array<int32_t, 2> low{};
    std::array<int32_t, 2> high{};
    for (size_t i = 0; i < 2; ++i) {
      const double first_m = std::floor(s.mean_m[i] / size_m) * size_m;
      low[i] = cell_of(first_m - size_m) - header_.first_cell[i];
      high[i] = cell_of(first_m + 2 * size_m - 1e-6) - header_.first_cell[i];
    }
    for (int32_t y = low[1]; y <= high[1]; ++y) {
      for (int32_t x = low[0]; x <= high[0]; ++x) {
        if (is_inside(x, y)) {
          float & ground = ground_[index(x, y)];
          ground = std::min(ground, static_cast<float>(s.mean_m[2]));
        }
      }
    }
  }

  /// Columns of the next level: of the four quarters of each of its windows.
  void unite(uint32_t level) {
    const uint64_t * const from = columns_ + level * count();
    uint64_t * const to = columns_ + (level + 1) * count();
    const int32_t half = 1 << level;
    for (int32_t y = 0; y + half < header_.cells[1]; ++y) {
      for (int32_t x = 0; x + half < header_.cells[0]; ++x) {
        to[index(x, y)] = from[index(x, y)] | from[index(x + half, y)] | from[index(x, y + half)] |
                          from[index(x + half, y + half)];
      }
    }
  }

  void settle_floors() {
    for (uint32_t level = 0; level < search_levels; ++level) {
      const int32_t step = 1 << level;
      auto * floors = &memory_.at<Floor>(header_.floors_offset[level]);
      for (int32_t y = 0; y < header_.cells[1]; y += step) {
        for (int32_t x = 0; x < header_.cells[0]; x += step) {
          *floors++ = floor_of(x, y, step);
        }
      }
    }
  }

  Floor floor_of(int32_t x, int32_t y, int32_t step) const {
    Floor floor{std::numeric_limits<int16_t>::max(), std::numeric_limits<int16_t>::min()};
    for (int32_t v = y; v < y + step; ++v) {
      for (int32_t u = x; u < x + step; ++u) {
        const float ground = ground_[index(u, v)];
        if (ground < no_ground) {
          const auto cell =
            static_cast<int16_t>(std::floor(static_cast<double>(ground) / search_cell_m + 0.5));
          floor = {std::min(floor.low, cell), std::max(floor.high, cell)};
        }
      }
    }
    return floor;
  }

  bool is_inside(int32_t x, int32_t y) const {
    const auto is_so = [](int32_t place, int32_t cells) {
      return place >= search_reach && place < cells - search_reach;
    };
    return is_so(x, header_.cells[0]) && is_so(y, header_.cells[1]);
  }

  const VoxelMap & map_;
  const SearchMapHeader & header_;
  uint64_t * columns_;
  float * ground_;
  SharedMemory & memory_;
};

SearchMapHeader lay_out(const VoxelMap & map) {
  SearchMapHeader h{};
  h.magic = SearchMapHeader::magic_value;
  h.id = map.header().id;
  uint64_t count = 1;
  for (size_t i = 0; i < 2; ++i) {
    const MapHeader & from = map.header();
    const double first_m = from.origin_m[i] + from.first_cell[i] * from.voxel_size_m;
    const double last_m = first_m + from.cells[i] * from.voxel_size_m;
    h.first_cell[i] = cell_of(first_m) - search_reach;
    const int32_t inside = cell_of(last_m) + 1 - cell_of(first_m);
    constexpr auto whole = static_cast<int32_t>(root_cells);
    h.cells[i] = (inside + whole - 1) / whole * whole + 2 * search_reach;
    count *= static_cast<uint64_t>(h.cells[i]);
  }
  if (count > max_columns) {
    throw Error(
      ErrorCode::invalid_argument, "the map is too large to be searched: " + std::to_string(count) +
                                     " columns of 1 m, expected at most " +
                                     std::to_string(max_columns));
  }
  h.columns_offset = align_up(sizeof(SearchMapHeader));
  uint64_t end = h.columns_offset + search_levels * count * sizeof(uint64_t);
  for (uint32_t level = 0; level < search_levels; ++level) {
    h.floors_offset[level] = end;
    end += (count >> (2 * level)) * sizeof(Floor);
  }
  h.ground_offset = align_up(end);
  h.size_bytes = h.ground_offset + count * sizeof(float);
  return h;
}

}  // namespace

SearchMap::SearchMap(SharedMemory memory) : memory_(std::move(memory)) {
  if (
    memory_.size() < sizeof(SearchMapHeader) || header().magic != SearchMapHeader::magic_value ||
    memory_.size() < header().size_bytes) {
    throw Error(ErrorCode::corrupt, "no search map at " + memory_.path());
  }
}

const uint64_t * SearchMap::columns(uint32_t level) const noexcept {
  const SearchMapHeader & h = header();
  const auto count = static_cast<uint64_t>(h.cells[0]) * static_cast<uint64_t>(h.cells[1]);
  return &memory_.at<const uint64_t>(h.columns_offset) + level * count;
}

Floor SearchMap::floor(uint32_t level, uint32_t x, uint32_t y) const noexcept {
  const uint32_t width = static_cast<uint32_t>(header().cells[0]) >> level;
  return (
    &memory_.at<const Floor>(header().floors_offset[level]))[(y >> level) * width + (x >> level)];
}

double SearchMap::middle_m(size_t axis, uint32_t first, uint32_t columns) const noexcept {
  return (header().first_cell[axis] + static_cast<int32_t>(first) + 0.5 * columns) * search_cell_m;
}

double SearchMap::ground_m(uint32_t x, uint32_t y) const noexcept {
  const auto width = static_cast<uint32_t>(header().cells[0]);
  return static_cast<double>((&memory_.at<const float>(header().ground_offset))[y * width + x]);
}

uint64_t search_map_bytes(const VoxelMap & map) { return lay_out(map).size_bytes; }

SearchMap build_search_map(const VoxelMap & map) {
  const SearchMapHeader header = lay_out(map);
  SharedMemory memory = SharedMemory::anonymous("manycore-ndt-search-map", header.size_bytes);
  memory.at<SearchMapHeader>(0) = header;
  Builder(map, header, memory).build();
  return SearchMap(std::move(memory));
}

}  // namespace manycore::ndt
