// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <mutex>
#include <optional>

#include "transport/layout/topic_dsm_layout.hpp"
#include "transport/registry/membership.hpp"
#include "transport/registry/registry.hpp"

namespace manycore {

/// A block of SMEM that an endpoint is about to need.
struct NeededBlock {
  uint32_t cluster;
  uint64_t bytes;
  uint64_t cleared_bytes;  ///< from its beginning
  bool is_for_messages;    ///< leaves the control reserve alone

  bool operator==(const NeededBlock & other) const noexcept {
    return cluster == other.cluster && bytes == other.bytes &&
           cleared_bytes == other.cleared_bytes && is_for_messages == other.is_for_messages;
  }
};

/// A block of SMEM between the map of its cluster and what leads to it, in the hand of this
/// process: so it is backed, or given back to the system, without the registry lock, and freed if
/// the process is killed meanwhile. One thread of the process at a time. See
/// docs/design/memory.md, Hands.
///
/// A process without a line has no hand: it makes no blocks, and frees those that it takes up under
/// the lock.
class BlockInHand {
public:
  /// Blocks up to this size are allocated under the lock at once.
  static constexpr uint64_t max_bytes_at_once = min_hole_bytes;

  /// Waits for other threads of this process, and for the lock if an earlier user could not empty
  /// the hand.
  explicit BlockInHand(Registry & registry, long wait_ns = Registry::Lock::usual_wait_ns);
  /// Nothing while another thread uses the hand. Does not wait.
  static std::optional<BlockInHand> try_make(Registry & registry);
  BlockInHand(BlockInHand &&) noexcept = default;
  BlockInHand & operator=(BlockInHand &&) = delete;
  /// Frees what is left in the hand, if the lock is available in time.
  ~BlockInHand();

  /// Reserves a block under the registry lock and backs it without. Throws Error{no_space}, and the
  /// errors of `membership`.
  void make(const Membership & membership, const NeededBlock & needed);
  bool has(const NeededBlock & needed) const noexcept { return made_ == needed; }
  /// Waits for another process that is making a block like this one: its endpoint may be the one
  /// that needs it. False if there is none, or it takes longer than five seconds.
  bool await_another(const NeededBlock & needed) const;
  /// The block, for a caller that holds the registry lock and attaches it, then lets go of it.
  SegmentRef block() const noexcept { return SegmentRef{hand_->block.load()}; }
  void let_go() noexcept;

  /// Takes up a block to be freed, one at a time. The caller holds the registry lock, and clears
  /// what led to the block. A small block is freed at once, others by empty() without the lock.
  void take_up(SegmentRef block, uint64_t bytes) noexcept;
  bool is_empty() const noexcept;
  /// Frees the block that was taken up. Takes the registry lock. Throws Error{timeout}.
  void empty(long wait_ns);

private:
  BlockInHand(Registry & registry, std::unique_lock<std::mutex> && guard) noexcept;

  Registry & registry_;
  std::unique_lock<std::mutex> guard_;
  long wait_ns_;
  Hand * hand_;
  std::optional<NeededBlock> made_;
};

/// Frees what a process had in hand that held this line and has ended. Takes the registry lock.
void empty_hand_of_dead(Registry & registry, uint32_t line);

}  // namespace manycore
