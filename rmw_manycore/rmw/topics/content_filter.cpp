// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/common/checks.hpp"
#include "rmw/rmw.h"

// Filtering is up to the caller, as `is_cft_enabled` of each subscription reports.

namespace {

rmw_ret_t refuse_content_filter() {
  RMW_SET_ERROR_MSG("rmw_manycore does not support content filters");
  return RMW_RET_UNSUPPORTED;
}

}  // namespace

rmw_ret_t rmw_subscription_set_content_filter(
  rmw_subscription_t * subscription, const rmw_subscription_content_filter_options_t * options) {
  // Invariants
  MANYCORE_CHECK_HANDLE(subscription);
  MANYCORE_CHECK_ARGUMENT(options);

  // Implementation
  return refuse_content_filter();
}

rmw_ret_t rmw_subscription_get_content_filter(
  const rmw_subscription_t * subscription, rcutils_allocator_t * allocator,
  rmw_subscription_content_filter_options_t * options) {
  // Invariants
  MANYCORE_CHECK_HANDLE(subscription);
  MANYCORE_CHECK_ARGUMENT(allocator);
  MANYCORE_CHECK_ARGUMENT(options);

  // Implementation
  return refuse_content_filter();
}
