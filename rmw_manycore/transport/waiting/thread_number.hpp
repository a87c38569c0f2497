// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace manycore {

constexpr uint32_t thread_numbers = 127;

/// The calling thread's number, below `thread_numbers`: from its first call to its end its own,
/// while no more threads than that have one; further threads share numbers.
uint32_t thread_number() noexcept;

/// True while some thread shares its number.
bool are_thread_numbers_shared() noexcept;

}  // namespace manycore
