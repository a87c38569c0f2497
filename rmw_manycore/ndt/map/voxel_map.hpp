// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "ndt/common/options.hpp"
#include "platform/shared_memory.hpp"

namespace manycore::ndt {

/// One voxel as read by the kernel: one cache line, one AVX-512 register.
struct alignas(64) VoxelLine {
  float mean_m[3];              ///< relative to the map's origin
  float weight;                 ///< 1; 0 in line 0, "no voxel"
  float inverse_covariance[6];  ///< xx, xy, xz, yy, yz, zz
  float unused[6];
};
static_assert(sizeof(VoxelLine) == 64 && std::is_trivially_copyable_v<VoxelLine>);

/// A cell with a voxel, or next to one (the halo).
struct TableSlot {
  uint32_t key;         ///< key of the cell, or empty_key
  uint32_t list_index;  ///< index of its voxel list
};
static_assert(sizeof(TableSlot) == 8);

constexpr uint32_t empty_key = 0xFFFFFFFF;
constexpr uint32_t empty_list = 0;

/// Head of a voxel map in shared memory.
struct MapHeader {
  static constexpr uint64_t magic_value = 0x70616d7464636d72;
  static constexpr uint32_t layout_version = 2;
  uint64_t magic;
  uint32_t version;
  Search search;
  uint64_t id;  ///< unique: pid of the process that built the map, and a counter
  double voxel_size_m;
  double origin_m[3];     ///< in the map frame; a multiple of the voxel size
  int32_t first_cell[3];  ///< first cell of the grid, relative to the origin
  int32_t cells[3];       ///< size of the grid, with halo and border
  uint32_t voxel_count;
  uint32_t cell_count;
  uint32_t table_shift;  ///< 32 - log2(slots of the table)
  uint32_t list_length;
  uint64_t table_offset;
  uint64_t lists_offset;
  uint64_t lines_offset;
  uint64_t size_bytes;
};
static_assert(std::is_trivially_copyable_v<MapHeader>);

/// Addresses of a map's parts in this process.
struct MapView {
  const MapHeader * header;
  const TableSlot * table;
  const uint32_t * lists;   ///< voxel lines per cell, its own first; each list ends with 0
  const VoxelLine * lines;  ///< line 0 means "no voxel"
};

/// Immutable normal distributions of a map, in memory that other processes can map.
class VoxelMap {
public:
  /// Takes memory filled by build_voxel_map(). Throws Error{corrupt} for any other memory.
  explicit VoxelMap(SharedMemory memory);

  const MapHeader & header() const noexcept { return memory_.at<const MapHeader>(0); }
  MapView view() const noexcept;
  const SharedMemory & memory() const noexcept { return memory_; }

private:
  SharedMemory memory_;
};

/// Builds a map from `count` points (x, y, z [m], map frame). Ignores points that are not finite,
/// and from the first on every `without_every`th, unless that is 0.
/// Throws Error{invalid_argument} if no voxel has enough points, or if the points span more than
/// 2^32 voxels.
VoxelMap build_voxel_map(
  const double * xyz_m, size_t count, const MapOptions & options, size_t without_every = 0);

}  // namespace manycore::ndt
