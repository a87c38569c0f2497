// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>

#include "transport/layout/segment_layout.hpp"

namespace manycore {

enum class SpareUse : uint32_t {
  landing,  ///< of a publisher, for a match to come: room for messages
  entries,  ///< of a reader table or source table, for a match to come: control memory
  queue,    ///< of a subscription to come: control memory
  none,     ///< taken off what used it, to be freed
};

/// SMEM that nothing uses and its owner leads to: a process or an endpoint. It is reserved for an
/// endpoint or a match to come and backed without the registry lock, or freed in pieces. Changed
/// under the registry lock.
struct SpareBlock {
  std::atomic<uint64_t> ref;          ///< SegmentRef; null = none; stored last
  std::atomic<uint64_t> bytes;        ///< of the whole block
  std::atomic<uint32_t> kept_pieces;  ///< while it is freed, as GenerationEntry::kept_pieces
  std::atomic<SpareUse> use;

  bool fits(SpareUse wanted, uint32_t cluster, uint64_t wanted_bytes) const noexcept {
    return SegmentRef{ref.load()}.cluster() == cluster && use.load() == wanted &&
           bytes.load() == wanted_bytes && kept_pieces.load() == 0;
  }
  /// What led to the block before no longer does: a block with two owners would be freed twice.
  void put(SpareUse wanted, SegmentRef block, uint64_t length) noexcept {
    use.store(wanted);
    bytes.store(length);
    kept_pieces.store(0);
    ref.store(block.word);
  }
  /// Takes the block off its owner. If this process dies before the block is attached elsewhere,
  /// the next owner of the lock builds the map without it.
  SegmentRef take() noexcept { return SegmentRef{ref.exchange(0)}; }
};
static_assert(sizeof(SpareBlock) == 24);

}  // namespace manycore
