// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include <cstring>

#include "rmw/common/checks.hpp"
#include "rmw/common/error.hpp"
#include "rmw/rmw.h"
#include "rmw/serialization/serialized_message.hpp"
#include "rmw/serialization/type_support.hpp"

rmw_ret_t rmw_serialize(
  const void * ros_message, const rosidl_message_type_support_t * type_support,
  rmw_serialized_message_t * serialized_message) {
  // Invariants
  MANYCORE_CHECK_ARGUMENT(ros_message);
  MANYCORE_CHECK_ARGUMENT(type_support);
  MANYCORE_CHECK_ARGUMENT(serialized_message);

  // Implementation
  return rmw_manycore::guarded([&] {
    const rmw_manycore::Cdr cdr = rmw_manycore::cdr_of(type_support);
    const size_t bound = cdr.size_bound(ros_message);
    rmw_manycore::make_room(*serialized_message, bound);
    const size_t size = cdr.serialize(ros_message, serialized_message->buffer, bound);
    // The length includes the rounding, as in rmw_fastrtps_cpp.
    std::memset(serialized_message->buffer + size, 0, bound - size);
    serialized_message->buffer_length = bound;
    return RMW_RET_OK;
  });
}

rmw_ret_t rmw_deserialize(
  const rmw_serialized_message_t * serialized_message,
  const rosidl_message_type_support_t * type_support, void * ros_message) {
  // Invariants
  MANYCORE_CHECK_ARGUMENT(serialized_message);
  MANYCORE_CHECK_ARGUMENT(type_support);
  MANYCORE_CHECK_ARGUMENT(ros_message);

  // Implementation
  return rmw_manycore::guarded([&] {
    rmw_manycore::cdr_of(type_support)
      .deserialize(serialized_message->buffer, serialized_message->buffer_length, ros_message);
    return RMW_RET_OK;
  });
}

rmw_ret_t rmw_get_serialized_message_size(
  const rosidl_message_type_support_t *, const rosidl_runtime_c__Sequence__bound *, size_t *) {
  RMW_SET_ERROR_MSG("rmw_manycore does not support computing a message's size from its bounds");
  return RMW_RET_UNSUPPORTED;
}
