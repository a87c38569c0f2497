// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/borrowing/read.hpp"
#include "rmw/common/checks.hpp"
#include "rmw/common/error.hpp"
#include "rmw/common/tracepoints.hpp"
#include "rmw/rmw.h"
#include "rmw/topics/message_info.hpp"
#include "rmw/topics/subscription.hpp"

namespace rmw_manycore {
namespace {

/// `info` may be null.
bool take(Subscription & subscription, void * ros_message, rmw_message_info_t * info) {
  const auto taken = subscription.inbox().take([&](manycore::Claim & claim) {
    read(
      claim, subscription.cdr(), ros_message, subscription.process(),
      subscription.has_warned_of_copies);
  });
  if (taken && info != nullptr) {
    *info = to_rmw(*taken);
  }
  if (const auto traced = tracepoints().take) {
    traced(
      &subscription.handle, ros_message, info != nullptr ? info->source_timestamp : 0,
      taken.has_value());
  }
  return taken.has_value();
}

}  // namespace
}  // namespace rmw_manycore

using rmw_manycore::Subscription;

rmw_ret_t rmw_take(
  const rmw_subscription_t * subscription, void * ros_message, bool * taken,
  rmw_subscription_allocation_t *) {
  // Invariants
  MANYCORE_CHECK_HANDLE(subscription);
  MANYCORE_CHECK_ARGUMENT(ros_message);
  MANYCORE_CHECK_ARGUMENT(taken);

  // Implementation
  *taken = false;
  return rmw_manycore::guarded([&] {
    *taken = rmw_manycore::take(Subscription::of(subscription), ros_message, nullptr);
    return RMW_RET_OK;
  });
}

rmw_ret_t rmw_take_with_info(
  const rmw_subscription_t * subscription, void * ros_message, bool * taken,
  rmw_message_info_t * message_info, rmw_subscription_allocation_t *) {
  // Invariants
  MANYCORE_CHECK_HANDLE(subscription);
  MANYCORE_CHECK_ARGUMENT(ros_message);
  MANYCORE_CHECK_ARGUMENT(taken);
  MANYCORE_CHECK_ARGUMENT(message_info);

  // Implementation
  *taken = false;
  return rmw_manycore::guarded([&] {
    *taken = rmw_manycore::take(Subscription::of(subscription), ros_message, message_info);
    return RMW_RET_OK;
  });
}

rmw_ret_t rmw_take_sequence(
  const rmw_subscription_t * subscription, size_t count, rmw_message_sequence_t * message_sequence,
  rmw_message_info_sequence_t * message_info_sequence, size_t * taken,
  rmw_subscription_allocation_t *) {
  // Invariants
  MANYCORE_CHECK_HANDLE(subscription);
  MANYCORE_CHECK_ARGUMENT(message_sequence);
  MANYCORE_CHECK_ARGUMENT(message_info_sequence);
  MANYCORE_CHECK_ARGUMENT(taken);
  if (count == 0 || count > message_sequence->capacity || count > message_info_sequence->capacity) {
    RMW_SET_ERROR_MSG("count must be at least 1 and at most the capacity of both sequences");
    return RMW_RET_INVALID_ARGUMENT;
  }

  // Implementation
  *taken = 0;
  const rmw_ret_t result = rmw_manycore::guarded([&] {
    while (*taken < count && rmw_manycore::take(
                               Subscription::of(subscription), message_sequence->data[*taken],
                               &message_info_sequence->data[*taken])) {
      ++*taken;
    }
    return RMW_RET_OK;
  });
  message_sequence->size = *taken;
  message_info_sequence->size = *taken;
  return result;
}
