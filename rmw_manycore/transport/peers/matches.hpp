// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>

#include "transport/peers/peers.hpp"

namespace manycore {

/// What an endpoint's process counts of its matches, whenever it asks: a peer that comes and goes
/// between two calls is not counted. Thread-safe.
class Matches {
public:
  Matches(Registry & registry, const EndpointEntry & own) : peers_(registry, own) {}

  MatchedCount matched() const noexcept;
  IncompatibleCount incompatible() const noexcept;
  uint64_t incompatible_types() const noexcept;
  /// Publishers that died, and that no later one has replaced.
  uint64_t died() const noexcept;
  /// Calls `visit(const Peer &)` for each peer.
  template<typename Visit>
  void for_each(Visit visit) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    renew();
    for (const Peer & peer : peers_.all()) {
      visit(peer);
    }
  }

private:
  Peers::Counts counts() const noexcept;
  /// Without memory for a longer list, what was known before counts.
  void renew() const noexcept;

  mutable std::mutex mutex_;
  mutable Peers peers_;
};

}  // namespace manycore
