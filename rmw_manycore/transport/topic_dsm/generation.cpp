// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/topic_dsm/generation.hpp"

namespace manycore {

/// Stores `offset` last: the repair of the registry treats an entry with an offset as allocated,
/// and needs its size.
void Generation::reserve(
  Cluster & cluster, GenerationEntry & entry, uint64_t data_bytes, uint64_t count) {
  const uint64_t offset = cluster.reserve(extent_bytes(data_bytes, count));
  entry.descriptor_count.store(static_cast<uint32_t>(count), std::memory_order_relaxed);
  entry.data_bytes.store(data_bytes, std::memory_order_relaxed);
  entry.offset.store(offset, std::memory_order_release);
}

void Generation::open(const Cluster & cluster, GenerationEntry & entry, uint64_t first) {
  cluster.back(entry.offset.load(std::memory_order_relaxed), entry.extent_bytes());
  const Generation generation = view(cluster, entry);
  for (uint64_t i = 0; i < generation.count; ++i) {
    generation.descriptors[i].number.store(no_record, std::memory_order_relaxed);
  }
  entry.first.store(first, std::memory_order_release);
}

void Generation::take_up(
  const Cluster & cluster, GenerationEntry & entry, BlockInHand & hand) noexcept {
  hand.take_up(SegmentRef::make(cluster.id(), entry.offset.load()), entry.extent_bytes());
  entry.offset.store(0, std::memory_order_release);
}

Generation Generation::view(const Cluster & cluster, GenerationEntry & entry) noexcept {
  Generation generation;
  generation.entry = &entry;
  generation.count = entry.descriptor_count.load(std::memory_order_relaxed);
  const uint64_t offset = entry.offset.load(std::memory_order_relaxed);
  generation.descriptors = cluster.find<RecordDescriptor>(offset);
  generation.data_offset = entry.data_offset();
  generation.data_bytes = entry.data_bytes.load(std::memory_order_relaxed);
  generation.first = entry.first.load(std::memory_order_relaxed);
  return generation;
}

}  // namespace manycore
