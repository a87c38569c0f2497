// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/topic_dsm/generation.hpp"

namespace manycore {

void Generation::allocate(
  Cluster & cluster, GenerationEntry & entry, uint64_t data_bytes, uint64_t count, uint64_t first) {
  const uint64_t offset = cluster.allocate(extent_bytes(data_bytes, count));
  // A reader may still be looking here for a number of a generation that was given back; it looks
  // at that generation's entry again before it believes what it finds.
  auto * const descriptors = cluster.find<RecordDescriptor>(offset);
  for (uint64_t i = 0; i < count; ++i) {
    descriptors[i].number.store(no_record, std::memory_order_relaxed);
  }
  entry.offset.store(offset, std::memory_order_relaxed);
  entry.descriptor_count.store(static_cast<uint32_t>(count), std::memory_order_relaxed);
  entry.data_bytes.store(data_bytes, std::memory_order_relaxed);
  entry.first.store(first, std::memory_order_release);
}

Generation Generation::view(const Cluster & cluster, GenerationEntry & entry) noexcept {
  Generation generation;
  generation.entry = &entry;
  generation.count = entry.descriptor_count.load(std::memory_order_relaxed);
  const uint64_t offset = entry.offset.load(std::memory_order_relaxed);
  generation.descriptors = cluster.find<RecordDescriptor>(offset);
  generation.data_offset = offset + generation.count * sizeof(RecordDescriptor);
  generation.data_bytes = entry.data_bytes.load(std::memory_order_relaxed);
  generation.first = entry.first.load(std::memory_order_relaxed);
  return generation;
}

}  // namespace manycore
