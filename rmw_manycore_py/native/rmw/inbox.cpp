// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/inbox.hpp"

#include <algorithm>

namespace rmw_manycore {

uint64_t Inbox::unread() const {
  if (!subscription_->has_data()) {
    return 0;
  }
  const uint64_t gone = claimed_.load(std::memory_order_relaxed) + subscription_->lost();
  const uint64_t arrivals = subscription_->arrivals();
  return std::max<uint64_t>(1, arrivals > gone ? arrivals - gone : 0);
}

}  // namespace rmw_manycore
