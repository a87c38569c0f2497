// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "ndt/map/voxel_map.hpp"

#include <utility>

#include "platform/error.hpp"

namespace manycore::ndt {

VoxelMap::VoxelMap(SharedMemory memory) : memory_(std::move(memory)) {
  const bool fits = memory_.size() >= sizeof(MapHeader);
  if (
    !fits || header().magic != MapHeader::magic_value ||
    header().version != MapHeader::layout_version || header().size_bytes > memory_.size()) {
    throw Error(ErrorCode::corrupt, "the memory does not hold a voxel map of this version");
  }
}

MapView VoxelMap::view() const noexcept {
  const MapHeader & h = header();
  return {
    &h, &memory_.at<const TableSlot>(h.table_offset), &memory_.at<const uint32_t>(h.lists_offset),
    &memory_.at<const VoxelLine>(h.lines_offset)};
}

}  // namespace manycore::ndt
