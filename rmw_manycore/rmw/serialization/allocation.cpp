// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/error_handling.h"
#include "rmw/rmw.h"

// Publishing and taking allocate nothing per message, so preallocation is not supported.

namespace {

rmw_ret_t refuse_preallocation() {
  RMW_SET_ERROR_MSG(
    "rmw_manycore does not support preallocation: it allocates nothing per message");
  return RMW_RET_UNSUPPORTED;
}

}  // namespace

rmw_ret_t rmw_init_publisher_allocation(
  const rosidl_message_type_support_t *, const rosidl_runtime_c__Sequence__bound *,
  rmw_publisher_allocation_t *) {
  return refuse_preallocation();
}

rmw_ret_t rmw_fini_publisher_allocation(rmw_publisher_allocation_t *) {
  return refuse_preallocation();
}

rmw_ret_t rmw_init_subscription_allocation(
  const rosidl_message_type_support_t *, const rosidl_runtime_c__Sequence__bound *,
  rmw_subscription_allocation_t *) {
  return refuse_preallocation();
}

rmw_ret_t rmw_fini_subscription_allocation(rmw_subscription_allocation_t *) {
  return refuse_preallocation();
}
