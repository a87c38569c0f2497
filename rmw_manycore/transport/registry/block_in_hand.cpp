// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/registry/block_in_hand.hpp"

#include <chrono>
#include <cstring>
#include <utility>

#include "platform/clock.hpp"
#include "platform/wall_sleep.hpp"

namespace manycore {
namespace {

constexpr int64_t max_wait_ns = 5 * ns_per_s;
constexpr std::chrono::milliseconds look_again_after{1};

/// What led to the block is cleared after this, and a repair finds the block in both places: then
/// the hand lets go of it.
void put(Hand & hand, SegmentRef block, uint64_t bytes) noexcept {
  hand.bytes.store(bytes);
  hand.block.store(block.word);
}

bool is_another_made(const RegistryHeader & header, const Hand * own, const NeededBlock & needed) {
  for (const Hand & hand : header.hands) {
    const SegmentRef block{hand.block.load()};
    if (
      &hand != own && block && block.cluster() == needed.cluster &&
      hand.bytes.load() == needed.bytes) {
      return true;
    }
  }
  return false;
}

}  // namespace

BlockInHand::BlockInHand(Registry & registry, std::unique_lock<std::mutex> && guard) noexcept
: registry_(registry),
  guard_(std::move(guard)),
  wait_ns_(Registry::Lock::no_wait_ns),
  hand_(registry.own_hand()) {}

BlockInHand::BlockInHand(Registry & registry, long wait_ns)
: BlockInHand(registry, std::unique_lock(registry.hand_mutex())) {
  wait_ns_ = wait_ns;
  empty(wait_ns);
}

std::optional<BlockInHand> BlockInHand::try_make(Registry & registry) {
  std::unique_lock guard(registry.hand_mutex(), std::try_to_lock);
  if (!guard.owns_lock()) {
    return std::nullopt;
  }
  BlockInHand in_hand(registry, std::move(guard));
  in_hand.empty(Registry::Lock::no_wait_ns);
  return in_hand;
}

BlockInHand::~BlockInHand() {
  if (!guard_.owns_lock()) {
    return;
  }
  try {
    empty(wait_ns_);
  } catch (const std::exception &) {
    // Another process holds the lock, or a repair lacks memory: the next user of the hand empties
    // it, or the reaper.
  }
}

void BlockInHand::make(const Membership & membership, const NeededBlock & needed) {
  empty(wait_ns_);
  Cluster & cluster = registry_.clusters().at(needed.cluster);
  uint64_t offset = 0;
  {
    const Registry::Lock lock(registry_, wait_ns_);
    membership.require();
    if (needed.is_for_messages) {
      cluster.require_message_room(needed.bytes);
    }
    offset = cluster.reserve(needed.bytes);
    put(*hand_, SegmentRef::make(needed.cluster, offset), needed.bytes);
  }
  if (needed.is_for_messages) {
    cluster.require_file_system_room(needed.bytes);
  }
  cluster.back(offset, needed.bytes);
  std::memset(cluster.find<uint8_t>(offset, needed.bytes), 0, needed.cleared_bytes);
  made_ = needed;
}

/// Polls, as this is rare: no room, and endpoints that are created at the same time.
bool BlockInHand::await_another(const NeededBlock & needed) const {
  const int64_t until_ns = monotonic_ns() + max_wait_ns;
  bool was_made = false;
  while (is_another_made(registry_.header(), hand_, needed)) {
    if (monotonic_ns() >= until_ns) {
      return false;
    }
    was_made = true;
    wall_sleep_for(look_again_after);
  }
  return was_made;
}

/// If this process dies before it, a repair finds the block attached as well.
void BlockInHand::let_go() noexcept {
  made_.reset();
  hand_->block.store(0);
}

void BlockInHand::take_up(SegmentRef block, uint64_t bytes) noexcept {
  Cluster * const cluster = registry_.clusters().find(block.cluster());
  if (cluster == nullptr) {
    return;  // damaged
  }
  if (hand_ != nullptr && cluster->makes_hole(bytes)) {
    put(*hand_, block, bytes);
  } else {
    cluster->free(block.offset(), bytes);
  }
}

bool BlockInHand::is_empty() const noexcept { return hand_ == nullptr || hand_->block.load() == 0; }

/// Until the hand is empty, nothing else has the block: a reaper may repeat all of it.
void BlockInHand::empty(long wait_ns) {
  made_.reset();
  if (is_empty()) {
    return;
  }
  const SegmentRef block{hand_->block.load()};
  const uint64_t bytes = hand_->bytes.load();
  Cluster & cluster = registry_.clusters().at(block.cluster());
  cluster.punch(block.offset(), bytes);
  const Registry::Lock lock(registry_, wait_ns);
  cluster.unmark(block.offset(), bytes);
  hand_->block.store(0);
}

void empty_hand_of_dead(Registry & registry, uint32_t line) {
  Hand & dead = registry.header().hands[line];
  if (dead.block.load() == 0 || &dead == registry.own_hand()) {
    return;
  }
  BlockInHand own(registry);
  {
    const Registry::Lock lock(registry);
    const SegmentRef block{dead.block.load()};
    if (!block || registry.lifelines().is_locked(line)) {
      return;
    }
    registry.map_cluster(block.cluster());
    own.take_up(block, dead.bytes.load());
    dead.block.store(0);
  }
  own.empty(Registry::Lock::usual_wait_ns);
}

}  // namespace manycore
