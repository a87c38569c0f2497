// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/serialization/serialized_message.hpp"

#include "rmw/common/error.hpp"
#include "rmw/error_handling.h"

namespace rmw_manycore {

void make_room(rmw_serialized_message_t & message, size_t bytes) {
  if (message.buffer_capacity >= bytes) {
    return;
  }
  const rmw_ret_t resized = rmw_serialized_message_resize(&message, bytes);
  if (resized != RMW_RET_OK) {
    rmw_reset_error();
    RMW_SET_ERROR_MSG_WITH_FORMAT_STRING(
      "cannot enlarge a serialized message from %zu to %zu bytes", message.buffer_capacity, bytes);
    throw RmwError(resized == RMW_RET_BAD_ALLOC ? RMW_RET_BAD_ALLOC : RMW_RET_ERROR);
  }
}

}  // namespace rmw_manycore
