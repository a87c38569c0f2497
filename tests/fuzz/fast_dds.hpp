// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "rmw/rmw.h"

/// rmw_deserialize of rmw_fastrtps_cpp, from its library: the verdict that ours has to equal.
class FastDds {
public:
  /// Throws std::runtime_error without rmw_fastrtps_cpp.
  FastDds();

  /// False when it refuses the bytes. `message` keeps what was read until then.
  bool accepts(
    const rmw_serialized_message_t & cdr, const rosidl_message_type_support_t & type,
    void * message) const;

private:
  decltype(&rmw_deserialize) deserialize_;
};
