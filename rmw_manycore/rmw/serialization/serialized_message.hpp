// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "rmw/serialized_message.h"

namespace rmw_manycore {

/// Enlarges the buffer to at least `bytes`. Throws RmwError if its allocator cannot.
void make_room(rmw_serialized_message_t & message, size_t bytes);

}  // namespace rmw_manycore
