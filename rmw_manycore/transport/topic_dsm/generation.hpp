// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/layout/topic_dsm_layout.hpp"
#include "transport/registry/block_in_hand.hpp"
#include "transport/registry/cluster.hpp"

namespace manycore {

constexpr uint64_t record_alignment = 64;
constexpr uint64_t first_data_bytes = 2048;
constexpr uint64_t first_descriptor_count = 16;

/// Rounds up to a descriptor count, which is a power of two.
constexpr uint64_t power_of_two_at_least(uint64_t x) {
  uint64_t power = 1;
  while (power < x) {
    power *= 2;
  }
  return power;
}

/// A publisher's view of one generation of its topic DSM.
struct Generation {
  GenerationEntry * entry = nullptr;
  RecordDescriptor * descriptors = nullptr;
  uint64_t count = 0;        ///< of descriptors
  uint64_t data_offset = 0;  ///< offset in the cluster segment
  uint64_t data_bytes = 0;
  uint64_t first = 0;  ///< number of its first record
  // Valid in an old generation:
  uint64_t end = 0;             ///< one past the number of its last record
  uint64_t drained_before = 0;  ///< records below this number are drained
  bool is_unread = false;       ///< closed, and no reader reads from it

  RecordDescriptor & descriptor(uint64_t number) const noexcept {
    return descriptors[number & (count - 1)];
  }

  static constexpr uint64_t extent_bytes(uint64_t data_bytes, uint64_t count) {
    return count * sizeof(RecordDescriptor) + data_bytes;
  }
  /// Reserves SMEM for a generation. The caller holds the registry lock. Throws
  /// Error{no_space|corrupt}.
  static void reserve(
    Cluster & cluster, GenerationEntry & entry, uint64_t data_bytes, uint64_t count);
  /// Backs the SMEM with memory, then opens the generation to readers. Needs no lock. Throws
  /// Error{no_space}.
  static void open(const Cluster & cluster, GenerationEntry & entry, uint64_t first);
  /// Takes the generation's SMEM up to be freed. The caller holds the registry lock.
  static void take_up(
    const Cluster & cluster, GenerationEntry & entry, BlockInHand & hand) noexcept;
  static Generation view(const Cluster & cluster, GenerationEntry & entry) noexcept;
};

}  // namespace manycore
