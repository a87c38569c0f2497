// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace manycore {

constexpr uint32_t thread_numbers = 126;
/// Numbers that one thread at a time has; the others are shared.
constexpr uint32_t unique_thread_numbers = 100;

constexpr bool is_shared_number(uint32_t number) noexcept {
  return number >= unique_thread_numbers;
}

/// Number of the calling thread from its first call to its end, below `thread_numbers`. A shared
/// one if all unique numbers are taken at that first call.
uint32_t thread_number() noexcept;

}  // namespace manycore
