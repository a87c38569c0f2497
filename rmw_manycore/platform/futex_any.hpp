// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "platform/futex.hpp"

namespace manycore {

/// One word of a sleep on several. Laid out as `futex_waitv` of the kernel, which older headers do
/// not have.
struct AwaitedWord {
  AwaitedWord(const FutexWord & word, uint32_t seen_value) noexcept
  : seen(seen_value), address(reinterpret_cast<uintptr_t>(&word)) {}

  uint64_t seen;
  uint64_t address;
  uint32_t flags = 2;  ///< 32 bits (FUTEX_32), shared by processes
  uint32_t reserved = 0;
};
static_assert(sizeof(AwaitedWord) == 24);

/// Sleeps while each word is what was seen of it, at most until `deadline_ns` (CLOCK_MONOTONIC).
/// May return early: where the kernel cannot do it (before Linux 5.16, or more than 128 words) it
/// returns after 10 ms.
void futex_wait_any(std::vector<AwaitedWord> & words, std::optional<int64_t> deadline_ns) noexcept;

}  // namespace manycore
