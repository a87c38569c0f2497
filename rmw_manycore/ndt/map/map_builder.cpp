// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// Builds the memory image of a voxel map from points.

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>
#include <vector>

#include "ndt/common/alignment.hpp"
#include "ndt/map/grid.hpp"
#include "ndt/map/neighbours.hpp"
#include "ndt/map/table.hpp"
#include "ndt/map/voxel_map.hpp"
#include "ndt/map/voxel_statistics.hpp"
#include "platform/error.hpp"

namespace manycore::ndt {
namespace {

using Points = std::vector<std::array<double, 3>>;

Points finite_points(const double * xyz_m, size_t count, size_t without_every) {
  Points points;
  points.reserve(count);
  for (size_t i = 0; i < count; ++i) {
    const std::array<double, 3> point{xyz_m[3 * i], xyz_m[3 * i + 1], xyz_m[3 * i + 2]};
    const bool is_left_out = without_every != 0 && i % without_every == 0;
    if (is_finite(point) && !is_left_out) {
      points.push_back(point);
    }
  }
  return points;
}

VoxelLine line_of(const Grid & grid, const Scatter & scatter, const Matrix3 & inverse) {
  VoxelLine line{};
  line.weight = 1;
  size_t next = 0;
  for (size_t i = 0; i < 3; ++i) {
    line.mean_m[i] = static_cast<float>(scatter.mean[i] - grid.origin_m[i]);
    for (size_t j = i; j < 3; ++j) {
      line.inverse_covariance[next++] = static_cast<float>(inverse[i][j]);
    }
  }
  return line;
}

/// Voxels with enough points, sorted by key.
std::vector<PlacedVoxel> voxels_of(
  const Grid & grid, const Points & points, const MapOptions & options) {
  std::vector<std::pair<uint32_t, uint32_t>> order;  // cell key, point index
  order.reserve(points.size());
  for (size_t i = 0; i < points.size(); ++i) {
    order.emplace_back(grid.key_of(grid.cell_of(points[i].data())), static_cast<uint32_t>(i));
  }
  std::sort(order.begin(), order.end());

  std::vector<PlacedVoxel> voxels;
  for (size_t begin = 0, end = 0; begin < order.size(); begin = end) {
    Scatter scatter;
    for (; end < order.size() && order[end].first == order[begin].first; ++end) {
      scatter.add(points[order[end].second]);
    }
    if (scatter.count < options.min_points_per_voxel) {
      continue;
    }
    if (const auto inverse = inverse_covariance(scatter, options)) {
      const Cell cell = grid.cell_of(points[order[begin].second].data());
      voxels.push_back({cell, line_of(grid, scatter, *inverse)});
    }
  }
  return voxels;
}

MapHeader lay_out(const Grid & grid, Search search, size_t voxels, const NeighbourLists & seen) {
  MapHeader h{};
  h.magic = MapHeader::magic_value;
  h.version = MapHeader::layout_version;
  h.search = search;
  static std::atomic<uint32_t> maps{0};
  h.id = (static_cast<uint64_t>(getpid()) << 32) | ++maps;
  h.voxel_size_m = grid.voxel_size_m;
  std::copy(grid.origin_m.begin(), grid.origin_m.end(), h.origin_m);
  std::copy(grid.first.begin(), grid.first.end(), h.first_cell);
  std::copy(grid.cells.begin(), grid.cells.end(), h.cells);
  h.voxel_count = static_cast<uint32_t>(voxels);
  h.cell_count = static_cast<uint32_t>(seen.cells.size());
  h.list_length = static_cast<uint32_t>(seen.lists.size());
  // Load factor of at most one third, so that most lookups hit the first slot.
  uint32_t bits = 4;
  while ((uint64_t{1} << bits) < 3 * seen.cells.size()) {
    ++bits;
  }
  h.table_shift = 32 - bits;
  h.table_offset = align_up(sizeof(MapHeader));
  h.lists_offset = align_up(h.table_offset + (sizeof(TableSlot) << bits));
  h.lines_offset = align_up(h.lists_offset + seen.lists.size() * sizeof(uint32_t));
  h.size_bytes = h.lines_offset + (voxels + 1) * sizeof(VoxelLine);
  return h;
}

void fill_table(const MapHeader & h, TableSlot * table, const std::vector<TableSlot> & cells) {
  const uint32_t mask = 0xFFFFFFFFu >> h.table_shift;
  std::fill(table, table + mask + 1, TableSlot{empty_key, empty_list});
  for (const TableSlot & cell : cells) {
    uint32_t slot = first_slot(cell.key, h.table_shift);
    while (table[slot].key != empty_key) {
      slot = (slot + 1) & mask;
    }
    table[slot] = cell;
  }
}

}  // namespace

VoxelMap build_voxel_map(
  const double * xyz_m, size_t count, const MapOptions & options, size_t without_every) {
  const Points points = finite_points(xyz_m, count, without_every);
  const auto refuse = [&](const std::string & found) {
    throw Error(
      ErrorCode::invalid_argument, "the map has " + found + ": expected voxels of " +
                                     std::to_string(options.voxel_size_m) + " m with at least " +
                                     std::to_string(options.min_points_per_voxel) + " points");
  };
  if (points.empty()) {
    refuse("no finite point");
  }
  const Grid grid = grid_around(points, options.voxel_size_m);
  const std::vector<PlacedVoxel> voxels = voxels_of(grid, points, options);
  if (voxels.empty()) {
    refuse(std::to_string(points.size()) + " points and no voxel with enough of them");
  }
  const NeighbourLists seen = neighbour_lists(grid, voxels, options.search);
  const MapHeader header = lay_out(grid, options.search, voxels.size(), seen);

  SharedMemory memory = SharedMemory::anonymous("manycore-ndt-map", header.size_bytes);
  memory.at<MapHeader>(0) = header;
  fill_table(header, &memory.at<TableSlot>(header.table_offset), seen.cells);
  std::copy(seen.lists.begin(), seen.lists.end(), &memory.at<uint32_t>(header.lists_offset));
  VoxelLine * line = &memory.at<VoxelLine>(header.lines_offset);
  *line++ = VoxelLine{};
  for (const PlacedVoxel & voxel : voxels) {
    *line++ = voxel.line;
  }
  return VoxelMap(std::move(memory));
}

}  // namespace manycore::ndt
