// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/events/inbox.hpp"

#include <algorithm>

#include "platform/clock.hpp"
#include "rcutils/logging_macros.h"
#include "rmw/common/identifier.hpp"

namespace rmw_manycore {

void Inbox::warn_of_drop(size_t size, const char * reason) noexcept {
  const int64_t now_ns = manycore::monotonic_ns();
  int64_t next_ns = next_warning_ns_.load(std::memory_order_relaxed);
  if (
    now_ns >= next_ns &&
    next_warning_ns_.compare_exchange_strong(next_ns, now_ns + manycore::ns_per_s)) {
    RCUTILS_LOG_WARN_NAMED(
      identifier,
      "dropped %zu bytes on '%s' that are not a valid %s: %s (%lu messages lost so far)", size,
      subscription_->topic(), subscription_->type(), reason, subscription_->lost());
  }
}

uint64_t Inbox::unread() const {
  if (!subscription_->has_data() && !subscription_->is_under_way()) {
    return 0;
  }
  return std::max<uint64_t>(1, subscription_->waiting());
}

}  // namespace rmw_manycore
