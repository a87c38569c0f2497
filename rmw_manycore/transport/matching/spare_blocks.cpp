// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/matching/spare_blocks.hpp"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <thread>

#include "platform/clock.hpp"
#include "transport/layout/topic_dsm_layout.hpp"

namespace manycore::spare_blocks {
namespace {

constexpr int64_t max_wait_ns = 5 * ns_per_s;
constexpr std::chrono::milliseconds look_again_after{1};

bool is_another_made(Registry & registry, const SpareBlock & own, const Needed & needed) {
  for (uint32_t slot = 0; slot < registry.endpoints().high_water(); ++slot) {
    const SpareBlock & spare = registry.endpoints()[slot].spare;
    if (&spare != &own && spare.fits(needed.use, needed.cluster, needed.bytes)) {
      return true;
    }
  }
  return false;
}

}  // namespace

/// Polls, as this is rare: no room, and endpoints that are created at the same time.
bool await_another(Registry & registry, const SpareBlock & own, const Needed & needed) {
  const int64_t until_ns = monotonic_ns() + max_wait_ns;
  bool was_made = false;
  while (is_another_made(registry, own, needed)) {
    if (monotonic_ns() >= until_ns) {
      return false;
    }
    was_made = true;
    std::this_thread::sleep_for(look_again_after);
  }
  return was_made;
}

/// Entries and queues are control blocks, which may use the reserve of the SMEM.
void make(
  Registry & registry, const Membership & membership, SpareBlock & spare, const Needed & needed) {
  free_all(registry, membership, spare);
  Cluster & cluster = registry.clusters().at(needed.cluster);
  uint64_t offset = 0;
  {
    const Registry::Lock lock(registry);
    membership.require();
    if (needed.use == SpareUse::landing) {
      cluster.require_message_room(needed.bytes);
    }
    offset = cluster.reserve(needed.bytes);
    spare.put(needed.use, SegmentRef::make(needed.cluster, offset), needed.bytes);
  }
  try {
    if (needed.use == SpareUse::landing) {
      cluster.require_file_system_room(needed.bytes);
    }
    cluster.back(offset, needed.bytes);
  } catch (...) {
    free_all(registry, membership, spare);  // a match would take it as if it had memory behind it
    throw;
  }
  std::memset(cluster.find<uint8_t>(offset, needed.bytes), 0, needed.cleared_bytes);
}

void free_all(Registry & registry, const Membership & membership, SpareBlock & spare) {
  for (bool is_free = spare.ref.load() == 0; !is_free;) {
    const Registry::Lock lock(registry);
    membership.require();
    Turn turn;
    is_free = free_some(registry, spare, turn);
  }
}

/// The store to the entry comes after the piece was freed: if this process dies in between, the
/// next owner of the lock marks the piece as used again. The last one is that of `ref`, as 0 pieces
/// stand for a whole block.
bool free_some(Registry & registry, SpareBlock & spare, Turn & turn) {
  const SegmentRef ref{spare.ref.load()};
  Cluster * const cluster = ref ? registry.map_cluster(ref.cluster()) : nullptr;
  while (cluster != nullptr) {
    const uint64_t bytes = spare.bytes.load();
    if (!turn.begin_freeing(bytes)) {
      return false;
    }
    const uint32_t kept = cluster->free_last_piece(ref.offset(), bytes, spare.kept_pieces.load());
    if (kept == 0) {
      break;
    }
    spare.kept_pieces.store(kept);
  }
  spare.ref.store(0);
  return true;
}

void mark(Clusters & clusters, const SpareBlock & spare) noexcept {
  const SegmentRef ref{spare.ref.load()};
  Cluster * const cluster = ref ? clusters.find(ref.cluster()) : nullptr;
  if (cluster != nullptr) {
    cluster->mark_allocated(
      ref.offset(), kept_bytes(ref.offset(), spare.bytes.load(), spare.kept_pieces.load()));
  }
}

}  // namespace manycore::spare_blocks
