// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include <cstring>

#include "rmw/common/checks.hpp"
#include "rmw/common/error.hpp"
#include "rmw/common/tracepoints.hpp"
#include "rmw/rmw.h"
#include "rmw/serialization/serialized_message.hpp"
#include "rmw/topics/message_info.hpp"
#include "rmw/topics/subscription.hpp"

namespace rmw_manycore {
namespace {

/// RTPS transfers whole words, so subscribers of serialized messages expect zero padding to 4
/// bytes.
constexpr size_t word_bytes = 4;

/// A message for which the caller has no room counts as lost. `info` may be null.
bool copy_next(
  Subscription & subscription, rmw_serialized_message_t & message, rmw_message_info_t * info) {
  std::optional<manycore::Claim> claim = subscription.inbox().claim();
  if (!claim) {
    return false;
  }
  const size_t size = claim->size();
  const size_t padded = (size + word_bytes - 1) / word_bytes * word_bytes;
  try {
    make_room(message, padded);
  } catch (...) {
    claim->reject();
    throw;
  }
  if (size != 0) {
    std::memcpy(message.buffer, claim->data(), size);
    std::memset(message.buffer + size, 0, padded - size);
  }
  message.buffer_length = padded;
  if (info != nullptr) {
    *info = to_rmw(claim->info());
  }
  return true;
}

bool take_serialized(
  Subscription & subscription, rmw_serialized_message_t & message, rmw_message_info_t * info) {
  const bool taken = copy_next(subscription, message, info);
  if (const auto traced = tracepoints().take) {
    traced(&subscription.handle, &message, info != nullptr ? info->source_timestamp : 0, taken);
  }
  return taken;
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
