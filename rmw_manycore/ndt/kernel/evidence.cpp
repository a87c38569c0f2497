// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "ndt/kernel/evidence.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "ndt/common/matrix.hpp"
#include "ndt/kernel/pass.hpp"
#include "ndt/kernel/point_scores.hpp"
#include "ndt/map/grid.hpp"
#include "ndt/map/table.hpp"

namespace manycore::ndt {
namespace {

/// A ray steps through the map in parts of a voxel.
constexpr double steps_per_voxel = 2;
/// How far behind a surface a point has to lie, relative to the voxel size: rays that graze the
/// ground end close to its plane.
constexpr double behind_share = 0.5;
/// A plane's largest inverse variance is nearly the trace; that of a pole half of it.
constexpr double planar_share = 0.85;
constexpr int power_iterations = 4;
/// How steep a floor may be: the least height of its normal of length 1.
constexpr double level_normal = 0.9;
/// How far below or above the floor under the sensor that of another column may be: elsewhere on a
/// storey, not on the next one.
constexpr float storey_within_m = 1;
constexpr int32_t columns_beside = 2;  // of the sensor's, on each side, that show its floor

Vector3 times(const float * b, const Vector3 & x) {
  return {
    static_cast<double>(b[0]) * x[0] + static_cast<double>(b[1]) * x[1] +
      static_cast<double>(b[2]) * x[2],
    static_cast<double>(b[1]) * x[0] + static_cast<double>(b[3]) * x[1] +
      static_cast<double>(b[4]) * x[2],
    static_cast<double>(b[2]) * x[0] + static_cast<double>(b[4]) * x[1] +
      static_cast<double>(b[5]) * x[2]};
}

Vector3 minus(const Vector3 & a, const Vector3 & b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

Vector3 mean_of(const VoxelLine & line) {
  return {
    static_cast<double>(line.mean_m[0]), static_cast<double>(line.mean_m[1]),
    static_cast<double>(line.mean_m[2])};
}

/// A place in voxels from the corner of the map's first cell.
Vector3 in_cells(const MapHeader & map, const Vector3 & place_m) {
  Vector3 place = place_m;
  for (size_t i = 0; i < 3; ++i) {
    place[i] = place[i] / map.voxel_size_m - map.first_cell[i];
  }
  return place;
}

/// The cell of a place. Just before the first cell it is the first: that is at the border of the
/// map, where no voxels are.
Cell cell_of(const Vector3 & place) {
  constexpr double far = 1e9;  // outside of any map
  Cell cell;
  for (size_t i = 0; i < 3; ++i) {
    cell[i] = static_cast<int32_t>(std::clamp(place[i], -far, far));
  }
  return cell;
}

/// The voxel of the cell itself, the first of those in range of it; null without one.
const VoxelLine * own_voxel(const MapView & map, const Cell & cell) {
  const MapHeader & header = *map.header;
  uint32_t key = 0;
  for (size_t i = 3; i-- > 0;) {
    if (cell[i] < 0 || cell[i] >= header.cells[i]) {
      return nullptr;
    }
    key = key * static_cast<uint32_t>(header.cells[i]) + static_cast<uint32_t>(cell[i]);
  }
  const uint32_t line = map.lists[find_list(map, key)];
  const VoxelLine & voxel = map.lines[line];
  return line != 0 && cell_of(in_cells(header, mean_of(voxel))) == cell ? &voxel : nullptr;
}

/// The normal of a planar voxel.
std::optional<Vector3> normal_of(const VoxelLine & voxel) {
  const float * const b = voxel.inverse_covariance;
  Vector3 normal{1, 0.7, 0.4};
  for (int i = 0; i < power_iterations; ++i) {
    normal = times(b, normal);
    const double length = std::sqrt(dot(normal, normal));
    for (double & n : normal) {
      n /= length;
    }
  }
  const double largest = dot(times(b, normal), normal);
  const bool is_planar = largest >= planar_share * static_cast<double>(b[0] + b[3] + b[5]);
  return is_planar ? std::optional(normal) : std::nullopt;
}

bool is_floor(const VoxelLine & voxel) {
  const std::optional<Vector3> normal = normal_of(voxel);
  return normal && std::abs((*normal)[2]) > level_normal;
}

/// A column of the map.
struct Column {
  float floor_m;  ///< height of its floor, relative to the map's origin; NaN without voxels
  float around;   ///< columns with voxels among the eight around it
};

/// Columns of the map, each looked at once. The floor of one is that of the sensor's storey, if a
/// sensor is given and the column has that, else its lowest voxel.
class Columns {
public:
  explicit Columns(const MapView & map) : map_(map) {}
  Columns(const MapView & map, const Vector3 & sensor_m)
  : map_(map), sensors_floor_m_(floor_around(sensor_m)) {}

  const Column & at(const Cell & cell) {
    const int32_t x = cell[0];
    const int32_t y = cell[1];
    const auto [entry, is_new] = columns_.try_emplace(key_of(x, y));
    if (is_new) {
      entry->second.floor_m = floor_m(x, y);
      for (int32_t i = -1; i <= 1; ++i) {
        for (int32_t j = -1; j <= 1; ++j) {
          const bool is_beside = i != 0 || j != 0;
          entry->second.around += is_beside && !std::isnan(floor_m(x + i, y + j)) ? 1.0F : 0.0F;
        }
      }
    }
    return entry->second;
  }

private:
  static uint64_t key_of(int32_t x, int32_t y) {
    return (static_cast<uint64_t>(static_cast<uint32_t>(x)) << 32) | static_cast<uint32_t>(y);
  }

  /// The height of the floor below a place, the median of columns around it: a parked vehicle's
  /// roof looks like a floor. NaN without one.
  float floor_around(const Vector3 & place_m) const {
    const Cell middle = cell_of(in_cells(*map_.header, place_m));
    std::vector<float> found;
    for (int32_t x = -columns_beside; x <= columns_beside; ++x) {
      for (int32_t y = -columns_beside; y <= columns_beside; ++y) {
        const float height_m = floor_below({middle[0] + x, middle[1] + y, middle[2]}, place_m[2]);
        if (!std::isnan(height_m)) {
          found.push_back(height_m);
        }
      }
    }
    const auto median = found.begin() + static_cast<std::ptrdiff_t>(found.size() / 2);
    std::nth_element(found.begin(), median, found.end());
    return found.empty() ? std::nanf("") : *median;
  }

  /// The height of the highest floor in a column below a cell and a height; NaN without one.
  float floor_below(Cell cell, double below_m) const {
    for (cell[2] = std::min(cell[2], map_.header->cells[2] - 1); cell[2] >= 0; --cell[2]) {
      const VoxelLine * const voxel = own_voxel(map_, cell);
      if (voxel != nullptr && mean_of(*voxel)[2] < below_m && is_floor(*voxel)) {
        return voxel->mean_m[2];
      }
    }
    return std::nanf("");
  }

  float floor_m(int32_t x, int32_t y) {
    const auto [entry, is_new] = floor_m_.try_emplace(key_of(x, y), std::nanf(""));
    const float lowest_m = sensors_floor_m_ - storey_within_m;
    for (int32_t z = 0; is_new && z < map_.header->cells[2]; ++z) {
      const VoxelLine * const voxel = own_voxel(map_, {x, y, z});
      if (voxel == nullptr) {
        continue;
      }
      const float height_m = voxel->mean_m[2];
      const bool is_beyond = !(height_m < sensors_floor_m_ + storey_within_m);
      if (std::isnan(entry->second) || (!is_beyond && height_m > lowest_m && is_floor(*voxel))) {
        entry->second = height_m;
      }
      if (is_beyond || entry->second > lowest_m) {
        break;  // also without a floor under the sensor
      }
    }
    return entry->second;
  }

  const MapView & map_;
  std::unordered_map<uint64_t, Column> columns_;
  std::unordered_map<uint64_t, float> floor_m_;
  const float sensors_floor_m_ = std::nanf("");
};

/// Whether a ray passes through the surface of a planar voxel to a place clearly behind it.
bool passes(
  const MapHeader & map, const VoxelLine & voxel, const Vector3 & from_m, const Vector3 & to_m) {
  const float * const b = voxel.inverse_covariance;
  const Vector3 mean = mean_of(voxel);
  const Vector3 ray = minus(to_m, from_m);
  const Vector3 bent = times(b, ray);
  const double nearest = dot(bent, minus(mean, from_m)) / dot(bent, ray);
  if (nearest <= 0 || nearest >= 1) {
    return false;
  }
  Vector3 x = minus(from_m, mean);
  for (size_t i = 0; i < 3; ++i) {
    x[i] += nearest * ray[i];
  }
  if (dot(times(b, x), x) > 1) {
    return false;
  }
  const std::optional<Vector3> normal = normal_of(voxel);
  if (!normal) {
    return false;
  }
  const double behind_m = dot(*normal, minus(to_m, mean));
  const double before_m = dot(*normal, minus(from_m, mean));
  return behind_m * before_m < 0 && std::abs(behind_m) > behind_share * map.voxel_size_m;
}

/// Shares of a ray between which it is in the map's cells: drivers may give points that are
/// arbitrarily far.
std::pair<double, double> part_in_map(
  const MapHeader & map, const Vector3 & from_m, const Vector3 & ray) {
  double first = 0;
  double last = 1;
  for (size_t i = 0; i < 3; ++i) {
    const double low_m = map.first_cell[i] * map.voxel_size_m - from_m[i];
    const double high_m = low_m + map.cells[i] * map.voxel_size_m;
    if (ray[i] != 0) {
      const auto [enters, leaves] = std::minmax({low_m / ray[i], high_m / ray[i]});
      first = std::max(first, enters);
      last = std::min(last, leaves);
    } else if (low_m > 0 || high_m < 0) {
      return {0, 0};
    }
  }
  return {first, last};
}

bool is_past_map(const MapView & map, const Vector3 & from_m, const Vector3 & to_m) {
  const Vector3 ray = minus(to_m, from_m);
  const double steps =
    std::floor(std::sqrt(dot(ray, ray)) * steps_per_voxel / map.header->voxel_size_m);
  const auto [first, last_share] = part_in_map(*map.header, from_m, ray);
  const Vector3 begin = in_cells(*map.header, from_m);
  const double per_step = 1 / (steps * map.header->voxel_size_m);
  const double end = std::min(std::ceil(last_share * steps) + 1, steps);
  Cell last = {-1, -1, -1};
  for (double step = std::max(std::floor(first * steps), 1.0); step < end; ++step) {
    const double part = step * per_step;
    const Cell cell =
      cell_of({begin[0] + ray[0] * part, begin[1] + ray[1] * part, begin[2] + ray[2] * part});
    if (cell == last) {
      continue;
    }
    last = cell;
    const VoxelLine * const voxel = own_voxel(map, cell);
    if (voxel != nullptr && passes(*map.header, *voxel, from_m, to_m)) {
      return true;
    }
  }
  return false;
}

/// Places of a scan's points, relative to the map's origin.
class Places {
public:
  Places(const MapView & map, const Pose6 & pose) : sensor_in_map_(to_matrix(pose)) {
    for (size_t i = 0; i < 3; ++i) {
      from_m_[i] = sensor_in_map_[4 * i + 3] - map.header->origin_m[i];
    }
  }

  /// That of the sensor.
  const Vector3 & from_m() const { return from_m_; }

  Vector3 of(const float * point) const {
    Vector3 place_m = from_m_;
    for (size_t i = 0; i < 3; ++i) {
      for (size_t j = 0; j < 3; ++j) {
        place_m[i] += sensor_in_map_[4 * i + j] * static_cast<double>(point[j]);
      }
    }
    return place_m;
  }

private:
  Pose4x4 sensor_in_map_;
  Vector3 from_m_{};
};

}  // namespace

void point_evidence(
  const MapView & map, double outlier_ratio, const Pose6 & pose, const float * xyz_m, size_t count,
  PointEvidence * evidence) {
  std::vector<float> scores(count);
  point_scores(map, outlier_ratio, pose, xyz_m, count, scores.data());
  const Places places(map, pose);
  Columns columns(map, places.from_m());
  for (size_t point = 0; point < count; ++point) {
    const Vector3 place_m = places.of(xyz_m + 3 * point);
    if (!is_finite(place_m)) {
      evidence[point] = {std::nanf(""), std::nanf(""), 0, 0};
      continue;
    }
    const Column & column = columns.at(cell_of(in_cells(*map.header, place_m)));
    evidence[point] = {
      scores[point], static_cast<float>(place_m[2]) - column.floor_m, column.around,
      is_past_map(map, places.from_m(), place_m) ? 1.0F : 0.0F};
  }
}

void columns_around(
  const MapView & map, const Pose6 & pose, const float * xyz_m, size_t count, uint8_t * around) {
  const Places places(map, pose);
  Columns columns(map);  // only whether they have voxels
  for (size_t point = 0; point < count; ++point) {
    const Vector3 place_m = places.of(xyz_m + 3 * point);
    around[point] = 0;
    if (is_finite(place_m)) {
      const Column & column = columns.at(cell_of(in_cells(*map.header, place_m)));
      around[point] = std::isnan(column.floor_m) ? 0 : static_cast<uint8_t>(column.around);
    }
  }
}

}  // namespace manycore::ndt
