// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/common/checks.hpp"
#include "rmw/dynamic_message_type_support.h"

// Dynamic messages require Fast DDS. rmw_feature_supported() reports them as unsupported.

namespace {

rmw_ret_t refuse_dynamic_message() {
  RMW_SET_ERROR_MSG("rmw_manycore does not support dynamic messages");
  return RMW_RET_UNSUPPORTED;
}

}  // namespace

rmw_ret_t rmw_take_dynamic_message(
  const rmw_subscription_t * subscription,
  rosidl_dynamic_typesupport_dynamic_data_t * dynamic_message, bool * taken,
  rmw_subscription_allocation_t *) {
  // Invariants
  MANYCORE_CHECK_HANDLE(subscription);
  MANYCORE_CHECK_ARGUMENT(dynamic_message);
  MANYCORE_CHECK_ARGUMENT(taken);

  // Implementation
  *taken = false;
  return refuse_dynamic_message();
}

rmw_ret_t rmw_take_dynamic_message_with_info(
  const rmw_subscription_t * subscription,
  rosidl_dynamic_typesupport_dynamic_data_t * dynamic_message, bool * taken,
  rmw_message_info_t * message_info, rmw_subscription_allocation_t *) {
  // Invariants
  MANYCORE_CHECK_HANDLE(subscription);
  MANYCORE_CHECK_ARGUMENT(dynamic_message);
  MANYCORE_CHECK_ARGUMENT(taken);
  MANYCORE_CHECK_ARGUMENT(message_info);

  // Implementation
  *taken = false;
  return refuse_dynamic_message();
}

rmw_ret_t rmw_serialization_support_init(
  const char * /*serialization_lib_name*/, rcutils_allocator_t * allocator,
  rosidl_dynamic_typesupport_serialization_support_t * serialization_support) {
  // Invariants
  MANYCORE_CHECK_ALLOCATOR(allocator);
  MANYCORE_CHECK_ARGUMENT(serialization_support);

  // Implementation
  return refuse_dynamic_message();
}
