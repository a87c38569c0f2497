// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>

#include "transport/layout/segment_layout.hpp"

namespace manycore {

/// What a match needs a block for.
enum class SpareUse : uint32_t {
  landing,  ///< of a publisher: room for messages
  entries,  ///< of a reader table or source table: control memory
};

/// SMEM that an endpoint has reserved for a match to come and backs without the registry lock,
/// before the match. Changed under the registry lock.
struct SpareBlock {
  std::atomic<uint64_t> ref;          ///< SegmentRef; null = none; stored last when reserved
  std::atomic<uint64_t> bytes;        ///< of the whole block
  std::atomic<uint32_t> kept_pieces;  ///< while it is freed, as GenerationEntry::kept_pieces
  std::atomic<SpareUse> use;

  bool fits(SpareUse wanted, uint32_t cluster, uint64_t wanted_bytes) const noexcept {
    return SegmentRef{ref.load()}.cluster() == cluster && use.load() == wanted &&
           bytes.load() == wanted_bytes && kept_pieces.load() == 0;
  }
  /// Takes the block off its owner. If this process dies before the block is attached elsewhere,
  /// the next owner of the lock builds the map without it.
  SegmentRef take() noexcept { return SegmentRef{ref.exchange(0)}; }
};
static_assert(sizeof(SpareBlock) == 24);

}  // namespace manycore
