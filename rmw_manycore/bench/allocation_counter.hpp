// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace manycore::bench {

/// Calls of malloc, calloc, realloc and their aligned kin in this process, by every thread and
/// library. Linking allocation_counter.cpp into a program puts it in the place of the C library's.
uint64_t allocations() noexcept;

}  // namespace manycore::bench
