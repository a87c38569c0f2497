// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/layout/topic_dsm_layout.hpp"
#include "transport/registry/cluster.hpp"

namespace manycore {

constexpr uint64_t record_alignment = 64;
constexpr uint64_t first_data_bytes = 2048;
constexpr uint64_t first_descriptor_count = 16;

/// Descriptor counts are powers of two.
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
  uint64_t data_offset = 0;  ///< in the cluster segment
  uint64_t data_bytes = 0;
  uint64_t first = 0;  ///< number of its first record
  // Of an old one:
  uint64_t end = 0;             ///< number behind its last record
  uint64_t drained_before = 0;  ///< nothing below this number is in it any more
  uint64_t released_bytes = 0;  ///< given back to the system

  RecordDescriptor & descriptor(uint64_t number) const noexcept {
    return descriptors[number & (count - 1)];
  }

  static constexpr uint64_t extent_bytes(uint64_t data_bytes, uint64_t count) {
    return count * sizeof(RecordDescriptor) + data_bytes;
  }
  /// Takes SMEM for a generation; the caller holds the registry lock. Throws
  /// Error{no_space|corrupt}.
  static void reserve(
    Cluster & cluster, GenerationEntry & entry, uint64_t data_bytes, uint64_t count);
  /// Backs it with memory, then shows it to readers; needs no lock. Throws Error{no_space}.
  static void open(const Cluster & cluster, GenerationEntry & entry, uint64_t first);
  /// A step of giving the memory back to the system, a few ms at most; true when it was the last.
  bool release_some(const Cluster & cluster) noexcept;
  /// Gives the SMEM back, and the memory behind it; the caller holds the registry lock.
  static void free(Cluster & cluster, GenerationEntry & entry) noexcept;
  static Generation view(const Cluster & cluster, GenerationEntry & entry) noexcept;
};

}  // namespace manycore
