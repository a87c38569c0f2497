// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/events/inbox.hpp"

#include <algorithm>

namespace rmw_manycore {

uint64_t Inbox::unread() const {
  if (!subscription_->has_data()) {
    return 0;
  }
  return std::max<uint64_t>(1, subscription_->waiting());
}

}  // namespace rmw_manycore
