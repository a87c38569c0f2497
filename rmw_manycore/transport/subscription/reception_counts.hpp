// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>

#include "transport/layout/subscription_layout.hpp"
#include "transport/registry/registry.hpp"

namespace manycore {

/// Messages taken and missed by one subscription; see docs/design/losses.md. Used
/// by one thread at a time (the subscription's mutex), except lost().
class ReceptionCounts {
public:
  ReceptionCounts(EndpointEntry & entry, SubscriptionHeader & header) noexcept
  : entry_(entry), header_(header) {}

  /// Returns the reception sequence number.
  uint64_t count_taken(uint64_t bytes) noexcept;
  /// Undoes count_taken() for a record that could not be deserialized, and counts it as lost.
  void count_rejected(uint64_t bytes) noexcept;
  void count_expired() noexcept;
  /// Messages may be missing that no later message has revealed yet.
  void suspect_losses() noexcept { unsettled_ = true; }
  bool is_unsettled() const noexcept { return unsettled_; }
  /// True if losses are suspected, or displaced hints make `lost` too high for now.
  bool needs_settling() const noexcept;
  /// Called when each message is accounted for, either as one of the `displaced` hints or as
  /// lost.
  void note_settled(uint64_t displaced) noexcept;

  /// Never decreases, although displaced hints may overestimate the losses.
  uint64_t lost() const noexcept;
  uint64_t superseded() const noexcept;

private:
  void count_lost(uint64_t count) noexcept;
  void store_taken(uint64_t bytes) noexcept;

  EndpointEntry & entry_;
  SubscriptionHeader & header_;
  uint64_t received_ = 0;
  bool unsettled_ = false;
  uint64_t settled_displaced_ = 0;  ///< displaced hints when all was accounted for
  mutable std::atomic<uint64_t> reported_lost_{0};
};

}  // namespace manycore
