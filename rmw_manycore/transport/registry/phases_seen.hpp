// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <unordered_map>

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
    uint64_t & seen = seen_[subscription].try_emplace(publisher, phase).first->second;
    if (phase != seen) {
      seen = was_out;
    }
    return seen == was_out;
  }
  void forget(uint64_t subscription) noexcept { seen_.erase(subscription); }

private:
  static constexpr uint64_t was_out = UINT64_MAX - 1;  ///< even, so no phase that was noted

  std::unordered_map<uint64_t, std::unordered_map<uint64_t, uint64_t>> seen_;
};

}  // namespace manycore
