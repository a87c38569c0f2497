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
  entry.kept_pieces.store(0, std::memory_order_relaxed);
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

/// Frees the last piece that is left, so that one store to the entry suffices per piece. The store
/// comes after the piece was freed: if this process dies in between, repair marks the piece as used
/// again, because the entry still holds it.
bool Generation::free_some(Cluster & cluster, GenerationEntry & entry) noexcept {
  const uint32_t kept_pieces = cluster.free_last_piece(
    entry.offset.load(std::memory_order_relaxed), entry.whole_bytes(),
    entry.kept_pieces.load(std::memory_order_relaxed));
  if (kept_pieces != 0) {
    entry.kept_pieces.store(kept_pieces, std::memory_order_release);
    return false;
  }
  entry.offset.store(0, std::memory_order_release);
  return true;
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
