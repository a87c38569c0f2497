// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "rmw/rmw.h"

/// rmw_deserialize of rmw_fastrtps_cpp, whose verdict rmw_manycore has to match.
class FastDds {
public:
  /// Throws std::runtime_error if rmw_fastrtps_cpp is not installed.
  FastDds();

  /// False if it refuses the bytes. `message` keeps what was read before that.
  bool accepts(
    const rmw_serialized_message_t & cdr, const rosidl_message_type_support_t & type,
    void * message) const;

private:
  decltype(&rmw_deserialize) deserialize_;
};
