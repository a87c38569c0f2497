// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/checks.hpp"
#include "rmw/rmw.h"

// Records hold CDR, not messages in memory form: there is nothing to lend. Publishers and
// subscriptions say so by `can_loan_messages`.

namespace {

template <typename Handle>
rmw_ret_t refuse(const Handle * handle) {
  MANYCORE_CHECK_HANDLE(handle);
  RMW_SET_ERROR_MSG("rmw_manycore does not lend messages");
  return RMW_RET_UNSUPPORTED;
}

}  // namespace

rmw_ret_t rmw_borrow_loaned_message(
  const rmw_publisher_t * publisher, const rosidl_message_type_support_t *, void **) {
  return refuse(publisher);
}

rmw_ret_t rmw_return_loaned_message_from_publisher(const rmw_publisher_t * publisher, void *) {
  return refuse(publisher);
}

rmw_ret_t rmw_publish_loaned_message(
  const rmw_publisher_t * publisher, void *, rmw_publisher_allocation_t *) {
  return refuse(publisher);
}

rmw_ret_t rmw_take_loaned_message(
  const rmw_subscription_t * subscription, void **, bool *, rmw_subscription_allocation_t *) {
  return refuse(subscription);
}

rmw_ret_t rmw_take_loaned_message_with_info(
  const rmw_subscription_t * subscription, void **, bool *, rmw_message_info_t *,
  rmw_subscription_allocation_t *) {
  return refuse(subscription);
}

rmw_ret_t rmw_return_loaned_message_from_subscription(
  const rmw_subscription_t * subscription, void *) {
  return refuse(subscription);
}
