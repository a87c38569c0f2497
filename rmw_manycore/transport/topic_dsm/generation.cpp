// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/topic_dsm/generation.hpp"

#include <algorithm>

namespace manycore {

/// `offset` last: a repairer of the registry goes by it, and then needs the size.
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

bool Generation::release_some(const Cluster & cluster) noexcept {
  constexpr uint64_t step_bytes = 512 << 10;  // a quarter of a millisecond
  const uint64_t all_bytes = entry->extent_bytes();
  const uint64_t bytes = std::min(step_bytes, all_bytes - released_bytes);
  cluster.release(entry->offset.load(std::memory_order_relaxed) + released_bytes, bytes);
  released_bytes += bytes;
  return released_bytes == all_bytes;
}

void Generation::free(Cluster & cluster, GenerationEntry & entry) noexcept {
  cluster.free(entry.offset.load(std::memory_order_relaxed), entry.extent_bytes());
  entry.offset.store(0, std::memory_order_release);
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
