// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/layout/segment_layout.hpp"

namespace manycore {

/// Head of a cluster segment: its receive thread's state and the map of its SMEM.
struct ClusterHeader {
  SegmentHeader segment;
  uint32_t granule_bytes;
  uint32_t granule_count;
  std::atomic<uint64_t> used_bytes;
  std::atomic<int32_t> receive_thread_pid;
  /// Set by a sender whose eMCOS message found the pipe full, after it set `resync` on its readers.
  std::atomic<uint32_t> pipe_overflow;
  std::atomic<uint64_t> messages;       ///< eMCOS messages handled
  std::atomic<uint64_t> notifications;  ///< hints pushed on subscriber queues
  std::atomic<uint64_t> charged_bytes;  ///< sum of its processes' (derived)
  /// Of granules: none below is free, and none from there on is used (derived).
  std::atomic<uint64_t> free_from;
  std::atomic<uint64_t> used_before;
  /// Odd while the receive thread follows references (see docs/design/topic_dsm.md, Freeing).
  alignas(64) std::atomic<uint64_t> phase;
};
static_assert(sizeof(ClusterHeader) == 192);

/// What messages leave of a cluster's SMEM, and of the file system its segment is in: the control
/// blocks of nodes that come later go there, so a full cluster still takes nodes.
constexpr uint64_t control_reserve_bytes(uint64_t total_bytes) {
  constexpr uint64_t most = 8 << 20;
  return total_bytes / 8 < most ? total_bytes / 8 : most;
}

/// The bit map of used granules follows the header. It is derived state.
constexpr uint64_t granule_map_offset = 256;

}  // namespace manycore
