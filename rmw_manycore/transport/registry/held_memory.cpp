// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/registry/held_memory.hpp"

#include <algorithm>
#include <cstddef>

#include "transport/layout/topic_dsm_layout.hpp"
#include "transport/registry/cluster.hpp"

namespace manycore {
namespace {

/// A copy of a struct in SMEM; all zero if it cannot be read.
template<typename T>
class Copied {
public:
  Copied(const Cluster & cluster, uint64_t offset) noexcept {
    cluster.copy_out(offset, bytes_, sizeof bytes_);
  }
  const T & operator*() const noexcept { return *reinterpret_cast<const T *>(bytes_); }

private:
  alignas(T) std::byte bytes_[sizeof(T)]{};
};

/// A copy of a ChunkEntry.
struct ChunkWords {
  uint64_t offset;
  uint64_t bytes;
};
static_assert(sizeof(ChunkWords) == sizeof(ChunkEntry));

std::vector<uint32_t> holders_of(Registry & registry, const Cluster & cluster, uint64_t offset) {
  const Copied<ChunkHead> copied(cluster, offset);
  const ChunkHead & head = *copied;
  std::vector<uint32_t> found;
  if (head.magic != chunk_magic) {
    return found;
  }
  for (const std::atomic<uint64_t> & word : head.holders) {
    const uint64_t holder = word.load(std::memory_order_relaxed);
    const uint32_t process = slot_in(holder);
    if (
      is_holding(registry, holder) &&
      std::find(found.begin(), found.end(), process) == found.end()) {
      found.push_back(process);
    }
  }
  return found;
}

void add_held(
  Registry & registry, const Cluster & cluster, const ChunkWords & entry,
  std::vector<HeldChunk> & all) {
  if (entry.offset == 0) {
    return;
  }
  std::vector<uint32_t> holders = holders_of(registry, cluster, entry.offset);
  if (!holders.empty()) {
    all.push_back({entry.bytes, std::move(holders)});
  }
}

/// Publishers without large messages are not looked at.
bool may_have_chunks(const EndpointEntry & publisher) noexcept {
  return publisher.kind == EndpointKind::publisher && publisher.role == EndpointRole::topic &&
         publisher.topic_dsm_size == 0 && publisher.transfer == Transfer::dsm &&
         publisher.counters.bytes.load(std::memory_order_relaxed) >= min_chunk_message_bytes;
}

}  // namespace

bool HeldChunk::is_held_by(uint32_t process) const noexcept {
  return std::find(processes.begin(), processes.end(), process) != processes.end();
}

std::vector<HeldChunk> held_chunks(Registry & registry, const EndpointEntry & publisher) {
  std::vector<HeldChunk> all;
  const Cluster * const cluster =
    may_have_chunks(publisher) ? registry.clusters().find(publisher.block.cluster()) : nullptr;
  if (cluster == nullptr) {
    return all;
  }
  const Copied<EntryBlocks> blocks(
    *cluster, publisher.block.offset() + offsetof(TopicDsmHeader, chunks));
  for (uint32_t block = 0; block < max_entry_blocks; ++block) {
    const uint64_t first = (*blocks).offsets[block].load(std::memory_order_relaxed);
    if (first == 0) {
      break;
    }
    std::vector<ChunkWords> entries(
      entry_block_bytes(block, cluster->granule_bytes()) / sizeof(ChunkEntry));
    if (cluster->copy_out(first, entries.data(), entries.size() * sizeof(ChunkEntry))) {
      for (const ChunkWords & entry : entries) {
        add_held(registry, *cluster, entry, all);
      }
    }
  }
  return all;
}

}  // namespace manycore
