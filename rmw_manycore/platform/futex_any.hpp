// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "platform/futex.hpp"

namespace manycore {

/// One word of a wait on several futexes. Same layout as `struct futex_waitv` of the kernel, which
/// older headers lack.
struct AwaitedWord {
  AwaitedWord(const FutexWord & word, uint32_t seen_value) noexcept
  : seen(seen_value), address(reinterpret_cast<uintptr_t>(&word)) {}

  uint64_t seen;
  uint64_t address;
  uint32_t flags = 2;  ///< FUTEX_32, shared between processes
  uint32_t reserved = 0;
};
static_assert(sizeof(AwaitedWord) == 24);

/// Sleeps while all words have their seen values, until `deadline_ns` (CLOCK_MONOTONIC) at the
/// latest. May return early. Returns after 10 ms if the kernel cannot wait on several words (before
/// Linux 5.16, or for more than 128 words).
void futex_wait_any(std::vector<AwaitedWord> & words, std::optional<int64_t> deadline_ns) noexcept;

}  // namespace manycore
