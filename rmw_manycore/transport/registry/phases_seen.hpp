// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <unordered_map>

#include "transport/layout/seat.hpp"

namespace manycore {

/// What one process knows of publishers that may still push to a closed subscription: a publisher
/// that is outside its phase, or in another one than before, does not find the subscription any
/// more. Kept between attempts to free it, so busy publishers need not be outside at one time.
class PhasesSeen {
public:
  /// Endpoints are named by endpoint_word(). `phase`: the publisher's, loaded now.
  bool is_out(uint64_t subscription, uint64_t publisher, uint64_t phase) {
    if (phase % 2 == 0) {
      return true;
    }
    OfSubscription & own = seen_[slot_in(subscription)];
    if (own.subscription != subscription) {
      own = {subscription, {}};  // not that of a former owner, which another process freed
    }
    uint64_t & seen = own.phases.try_emplace(publisher, phase).first->second;
    if (phase != seen) {
      seen = was_out;
    }
    return seen == was_out;
  }
  void forget(uint64_t subscription) noexcept { seen_.erase(slot_in(subscription)); }

private:
  static constexpr uint64_t was_out = UINT64_MAX - 1;  ///< even, so no phase that was noted

  struct OfSubscription {
    uint64_t subscription = 0;
    std::unordered_map<uint64_t, uint64_t> phases;  ///< by publisher
  };

  std::unordered_map<uint32_t, OfSubscription> seen_;  ///< by slot, so that it does not grow
};

}  // namespace manycore
