// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace manycore {

constexpr uint32_t thread_numbers = 126;

/// Number of the calling thread, below `thread_numbers`. Unique from the thread's first call to its
/// end while at most `thread_numbers` threads have one; further threads share numbers.
uint32_t thread_number() noexcept;

/// True while any thread shares its number.
bool are_thread_numbers_shared() noexcept;

}  // namespace manycore
