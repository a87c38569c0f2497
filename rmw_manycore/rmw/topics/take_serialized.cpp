// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include <cstring>

#include "rmw/common/checks.hpp"
#include "rmw/common/error.hpp"
#include "rmw/rmw.h"
#include "rmw/topics/message_info.hpp"
#include "rmw/topics/subscription.hpp"

namespace rmw_manycore {
namespace {

/// `info` may be null.
bool take_serialized(
  Subscription & subscription, rmw_serialized_message_t & message, rmw_message_info_t * info) {
  const std::optional<manycore::Claim> claim = subscription.inbox().claim();
  if (!claim) {
    return false;
  }
  if (message.buffer_capacity < claim->size()) {
    check(rmw_serialized_message_resize(&message, claim->size()));
  }
  if (claim->size() != 0) {
    std::memcpy(message.buffer, claim->data(), claim->size());
  }
  message.buffer_length = claim->size();
  if (info != nullptr) {
    *info = to_rmw(claim->info());
  }
  return true;
}

}  // namespace
}  // namespace rmw_manycore

using rmw_manycore::Subscription;

rmw_ret_t rmw_take_serialized_message(
  const rmw_subscription_t * subscription, rmw_serialized_message_t * serialized_message,
  bool * taken, rmw_subscription_allocation_t *) {
  // Invariants
  MANYCORE_CHECK_HANDLE(subscription);
  MANYCORE_CHECK_ARGUMENT(serialized_message);
  MANYCORE_CHECK_ARGUMENT(taken);

  // Implementation
  *taken = false;
  return rmw_manycore::guarded([&] {
    *taken =
      rmw_manycore::take_serialized(Subscription::of(subscription), *serialized_message, nullptr);
    return RMW_RET_OK;
  });
}

rmw_ret_t rmw_take_serialized_message_with_info(
  const rmw_subscription_t * subscription, rmw_serialized_message_t * serialized_message,
  bool * taken, rmw_message_info_t * message_info, rmw_subscription_allocation_t *) {
  // Invariants
  MANYCORE_CHECK_HANDLE(subscription);
  MANYCORE_CHECK_ARGUMENT(serialized_message);
  MANYCORE_CHECK_ARGUMENT(taken);
  MANYCORE_CHECK_ARGUMENT(message_info);

  // Implementation
  *taken = false;
  return rmw_manycore::guarded([&] {
    *taken = rmw_manycore::take_serialized(
      Subscription::of(subscription), *serialized_message, message_info);
    return RMW_RET_OK;
  });
}
