// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace manycore::bench {

/// Number of calls to malloc, calloc, realloc and the aligned variants in this process, by all
/// threads and libraries. Linking allocation_counter.cpp replaces the C library's functions.
uint64_t allocations() noexcept;

}  // namespace manycore::bench
