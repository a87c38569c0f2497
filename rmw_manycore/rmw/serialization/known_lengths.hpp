// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "rmw/serialization/cdr_lengths.hpp"
#include "rosidl_typesupport_fastrtps_cpp/message_type_support.h"

namespace rmw_manycore {

/// The length check of a type, shared by its entities and by calls of rmw_deserialize: creating it
/// takes longer than reading a small message. Thread-safe.
std::shared_ptr<const CdrLengths> lengths_of(
  const rosidl_message_type_support_t & type, const message_type_support_callbacks_t & callbacks);

}  // namespace rmw_manycore
