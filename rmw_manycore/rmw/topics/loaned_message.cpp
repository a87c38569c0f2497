// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/common/checks.hpp"
#include "rmw/common/error.hpp"
#include "rmw/rmw.h"
#include "rmw/topics/message_info.hpp"
#include "rmw/topics/publisher.hpp"
#include "rmw/topics/subscription.hpp"

// Only plain types, whose memory layout is their CDR, can be loaned, as in rmw_fastrtps_cpp. A loan
// saves the user a message object, not the copy into or out of the topic DSM.

using rmw_manycore::Publisher;
using rmw_manycore::Subscription;

/// The endpoint is valid and its type can be loaned.
#define MANYCORE_CHECK_LENDS(handle)                                                \
  MANYCORE_CHECK_HANDLE(handle);                                                    \
  if (!(handle)->can_loan_messages) {                                               \
    RMW_SET_ERROR_MSG(                                                              \
      "messages of this type cannot be loaned: their size or layout is not fixed"); \
    return RMW_RET_UNSUPPORTED;                                                     \
  }

namespace {

rmw_ret_t refuse_stranger() {
  RMW_SET_ERROR_MSG("this message is not on loan from this endpoint, or was already returned");
  return RMW_RET_ERROR;
}

template<typename Endpoint>
rmw_ret_t give_back(Endpoint & endpoint, const void * message) {
  return rmw_manycore::guarded(
    [&] { return endpoint.loans().give_back(message) ? RMW_RET_OK : refuse_stranger(); });
}

rmw_ret_t take_loaned(
  const rmw_subscription_t * handle, void ** loaned_message, bool * taken,
  rmw_message_info_t * info) {
  *taken = false;
  return rmw_manycore::guarded([&] {
    Subscription & subscription = Subscription::of(handle);
    void * const message = subscription.loans().lend();
    const auto found = subscription.inbox().take(subscription.cdr(), message);
    if (!found) {
      subscription.loans().give_back(message);
      return RMW_RET_OK;
    }
    if (info != nullptr) {
      *info = rmw_manycore::to_rmw(*found);
    }
    *loaned_message = message;
    *taken = true;
    return RMW_RET_OK;
  });
}

}  // namespace

rmw_ret_t rmw_borrow_loaned_message(
  const rmw_publisher_t * publisher, const rosidl_message_type_support_t * type_support,
  void ** ros_message) {
  // Invariants
  MANYCORE_CHECK_LENDS(publisher);
  MANYCORE_CHECK_ARGUMENT(type_support);
  MANYCORE_CHECK_ARGUMENT(ros_message);
  if (*ros_message != nullptr) {
    RMW_SET_ERROR_MSG("expected ros_message to point to a null pointer");
    return RMW_RET_INVALID_ARGUMENT;
  }

  // Implementation
  return rmw_manycore::guarded([&] {
    *ros_message = Publisher::of(publisher).loans().lend();
    return RMW_RET_OK;
  });
}

rmw_ret_t rmw_return_loaned_message_from_publisher(
  const rmw_publisher_t * publisher, void * loaned_message) {
  // Invariants
  MANYCORE_CHECK_LENDS(publisher);
  MANYCORE_CHECK_ARGUMENT(loaned_message);

  // Implementation
  return give_back(Publisher::of(publisher), loaned_message);
}

rmw_ret_t rmw_publish_loaned_message(
  const rmw_publisher_t * publisher, void * ros_message, rmw_publisher_allocation_t * allocation) {
  // Invariants
  MANYCORE_CHECK_LENDS(publisher);
  MANYCORE_CHECK_ARGUMENT(ros_message);

  // Implementation: a message that could not be published stays on loan
  return rmw_manycore::guarded([&] {
    if (!Publisher::of(publisher).loans().is_lent(ros_message)) {
      return refuse_stranger();
    }
    const rmw_ret_t published = rmw_publish(publisher, ros_message, allocation);
    return published == RMW_RET_OK ? give_back(Publisher::of(publisher), ros_message) : published;
  });
}

rmw_ret_t rmw_take_loaned_message(
  const rmw_subscription_t * subscription, void ** loaned_message, bool * taken,
  rmw_subscription_allocation_t *) {
  // Invariants
  MANYCORE_CHECK_LENDS(subscription);
  MANYCORE_CHECK_ARGUMENT(loaned_message);
  MANYCORE_CHECK_ARGUMENT(taken);

  // Implementation
  return take_loaned(subscription, loaned_message, taken, nullptr);
}

rmw_ret_t rmw_take_loaned_message_with_info(
  const rmw_subscription_t * subscription, void ** loaned_message, bool * taken,
  rmw_message_info_t * message_info, rmw_subscription_allocation_t *) {
  // Invariants
  MANYCORE_CHECK_LENDS(subscription);
  MANYCORE_CHECK_ARGUMENT(loaned_message);
  MANYCORE_CHECK_ARGUMENT(taken);
  MANYCORE_CHECK_ARGUMENT(message_info);

  // Implementation
  return take_loaned(subscription, loaned_message, taken, message_info);
}

rmw_ret_t rmw_return_loaned_message_from_subscription(
  const rmw_subscription_t * subscription, void * loaned_message) {
  // Invariants
  MANYCORE_CHECK_LENDS(subscription);
  MANYCORE_CHECK_ARGUMENT(loaned_message);

  // Implementation
  return give_back(Subscription::of(subscription), loaned_message);
}
