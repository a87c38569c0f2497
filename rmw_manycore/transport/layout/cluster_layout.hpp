// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/layout/segment_layout.hpp"

namespace manycore {

/// Head of a cluster segment: the state of its receive thread and the allocation state of its SMEM.
/// "Derived" fields are rebuilt after the owner of the registry lock died.
struct ClusterHeader {
  SegmentHeader segment;
  uint32_t granule_bytes;
  uint32_t granule_count;
  std::atomic<uint64_t> used_bytes;
  std::atomic<int32_t> receive_thread_pid;
  /// Set by a sender whose eMCOS message found the pipe full, after it set `resync` on its readers.
  std::atomic<uint32_t> pipe_overflow;
  std::atomic<uint64_t> messages;       ///< eMCOS messages handled by the receive thread
  std::atomic<uint64_t> notifications;  ///< hints pushed to subscriber queues by the receive thread
  /// Sum of ProcessEntry::charged_bytes over its processes (derived).
  std::atomic<uint64_t> charged_bytes;
  /// Granule indices: no granule below `free_from` is free, none from `used_before` on is used
  /// (derived).
  std::atomic<uint64_t> free_from;
  std::atomic<uint64_t> used_before;
  /// Odd while the receive thread follows references; see docs/design/rows_seats_hands.md.
  alignas(64) std::atomic<uint64_t> phase;
  /// The same of the threads that fill landings: of messages and of sessions.
  std::atomic<uint64_t> mover_phases[2];
  /// Receive threads that have taken over from a killed one, with its movers.
  alignas(64) std::atomic<uint64_t> successors;  // read by each hand-over
};
static_assert(sizeof(ClusterHeader) == 256);

/// Bytes of SMEM, and of the file system that holds the segment, which messages must leave free.
/// Control blocks of later nodes are allocated there, so a cluster full of messages still accepts
/// nodes.
constexpr uint64_t control_reserve_bytes(uint64_t total_bytes) {
  constexpr uint64_t most = 8 << 20;
  return total_bytes / 8 < most ? total_bytes / 8 : most;
}

/// The bitmap of used granules follows the header (derived).
constexpr uint64_t granule_map_offset = 256;

}  // namespace manycore
