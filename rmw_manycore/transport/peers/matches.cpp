// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/peers/matches.hpp"

#include <new>

namespace manycore {

void Matches::renew() const noexcept {
  try {
    peers_.refresh();
  } catch (const std::bad_alloc &) {
    peers_.forget_changes();
  }
}

Peers::Counts Matches::counts() const noexcept {
  const std::lock_guard<std::mutex> lock(mutex_);
  renew();
  return peers_.counts();
}

MatchedCount Matches::matched() const noexcept {
  const std::lock_guard<std::mutex> lock(mutex_);
  renew();
  return {peers_.counts().matched_total, peers_.all().size()};
}

IncompatibleCount Matches::incompatible() const noexcept {
  const Peers::Counts now = counts();
  return {now.incompatible_qos, now.last_policy};
}

uint64_t Matches::incompatible_types() const noexcept { return counts().incompatible_types; }

uint64_t Matches::died() const noexcept { return counts().died; }

}  // namespace manycore
