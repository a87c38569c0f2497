// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/layout/seat.hpp"
#include "transport/layout/topic_dsm_layout.hpp"
#include "transport/registry/block_in_hand.hpp"
#include "transport/registry/entry_table.hpp"
#include "transport/registry/held_memory.hpp"
#include "transport/registry/registry.hpp"

namespace manycore {

inline EntryTable<ChunkEntry> chunks_of(const Cluster & cluster, TopicDsmHeader & dsm) noexcept {
  return {cluster, dsm.chunks};
}

/// The entry of the chunk at an offset, or with `offset` = 0 a free one; nullptr if there is none.
inline ChunkEntry * find_chunk_entry(
  const Cluster & cluster, TopicDsmHeader & dsm, uint64_t offset) {
  ChunkEntry * found = nullptr;
  chunks_of(cluster, dsm).visit([&](ChunkEntry & entry) {
    found = entry.offset.load(std::memory_order_relaxed) == offset ? &entry : nullptr;
    return found != nullptr;
  });
  return found;
}

/// Head of the chunk that holds a record; nullptr if the reference is damaged.
inline ChunkHead * chunk_head(const Cluster & cluster, uint64_t data_offset) noexcept {
  ChunkHead * const head =
    data_offset < chunk_data ? nullptr : cluster.find<ChunkHead>(data_offset - chunk_data);
  return head != nullptr && head->magic == chunk_magic ? head : nullptr;
}

/// The loads are seq_cst: a reader stores its word before it ends its claim, which the caller has
/// not seen.
inline bool is_held(Registry & registry, const ChunkHead & head) noexcept {
  for (const std::atomic<uint64_t> & holder : head.holders) {
    if (is_holding(registry, holder.load(std::memory_order_seq_cst))) {
      return true;
    }
  }
  return false;
}

namespace chunk {

/// SMEM of a chunk for a message of this size.
constexpr uint64_t bytes_for(uint64_t message_bytes) {
  return align_up(message_bytes + chunk_data, 4096);
}

/// Reserves SMEM. The caller holds the registry lock. Throws Error{no_space|corrupt}.
inline void reserve(Cluster & cluster, ChunkEntry & entry, uint64_t bytes) {
  const uint64_t offset = cluster.reserve(bytes);
  entry.bytes.store(bytes, std::memory_order_relaxed);
  entry.offset.store(offset, std::memory_order_release);
}

/// Backs the SMEM with memory. Needs no lock. Throws Error{no_space}.
inline void open(const Cluster & cluster, const ChunkEntry & entry) {
  const uint64_t offset = entry.offset.load(std::memory_order_relaxed);
  cluster.back(offset, entry.bytes.load(std::memory_order_relaxed));
  auto & head = *cluster.find<ChunkHead>(offset);
  for (std::atomic<uint64_t> & holder : head.holders) {
    holder.store(0, std::memory_order_relaxed);
  }
  head.magic = chunk_magic;
}

/// Takes the SMEM up to be freed. The caller holds the registry lock.
inline void take_up(const Cluster & cluster, ChunkEntry & entry, BlockInHand & hand) noexcept {
  hand.take_up(SegmentRef::make(cluster.id(), entry.offset.load()), entry.bytes.load());
  entry.offset.store(0, std::memory_order_release);
}

}  // namespace chunk
}  // namespace manycore
