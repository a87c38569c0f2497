// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>

#include "transport/layout/subscription_layout.hpp"
#include "transport/registry/registry.hpp"

namespace manycore {

/// What one subscription took and lost. See docs/design/topic_dsm.md, Counting what is lost. One
/// thread at a time (the subscription's mutex), but for lost().
class ReceptionCounts {
public:
  ReceptionCounts(EndpointEntry & entry, SubscriptionHeader & header) noexcept
  : entry_(entry), header_(header) {}

  /// Returns the reception sequence number.
  uint64_t count_taken(uint64_t bytes) noexcept;
  /// What was counted as taken was no message.
  void count_rejected(uint64_t bytes) noexcept;
  void count_expired() noexcept;
  /// Replies that displacement does not count. The publisher numbers its replies to all clients
  /// together, so a client counts its own one by one as it misses them; nothing for other roles.
  void count_lost_replies(uint64_t count) noexcept;
  /// Messages may be missing that no later one has shown to be.
  void suspect_losses() noexcept { unsettled_ = true; }
  bool needs_settling() const noexcept;
  /// Every message is accounted for, as one of `dropped` displaced hints or as lost otherwise.
  void note_settled(uint64_t dropped) noexcept;

  /// Never falls, though what displaced hints suggest may turn out to be too much.
  uint64_t lost() const noexcept;

private:
  void count_lost(uint64_t count) noexcept;
  void store_taken(uint64_t bytes) noexcept;

  EndpointEntry & entry_;
  SubscriptionHeader & header_;
  uint64_t received_ = 0;
  bool unsettled_ = false;
  uint64_t settled_dropped_ = 0;  ///< of the header's `dropped`, when all was accounted for
  mutable std::atomic<uint64_t> reported_lost_{0};
};

}  // namespace manycore
