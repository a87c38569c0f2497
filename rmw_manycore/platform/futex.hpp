// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <linux/futex.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <climits>
#include <cstdint>
#include <optional>

#include "platform/clock.hpp"

namespace manycore {

using FutexWord = std::atomic<uint32_t>;
static_assert(sizeof(FutexWord) == 4 && FutexWord::is_always_lock_free);

/// Sleeps while `word` equals `seen`, until `deadline_ns` (CLOCK_MONOTONIC) at the latest. May
/// return early: true after a signal handler ran that was installed without SA_RESTART.
inline bool futex_wait(
  FutexWord & word, uint32_t seen, std::optional<int64_t> deadline_ns) noexcept {
  timespec until{};
  if (deadline_ns) {
    until = to_timespec(*deadline_ns);
  }
  // FUTEX_WAIT_BITSET takes an absolute timeout, so an interrupted wait needs no recomputation.
  const long result = syscall(
    SYS_futex, &word, FUTEX_WAIT_BITSET, seen, deadline_ns ? &until : nullptr, nullptr,
    FUTEX_BITSET_MATCH_ANY);
  return result != 0 && errno == EINTR;
}

inline void futex_wake_one(FutexWord & word) noexcept {
  syscall(SYS_futex, &word, FUTEX_WAKE, 1, nullptr, nullptr, 0);
}

inline void futex_wake_all(FutexWord & word) noexcept {
  syscall(SYS_futex, &word, FUTEX_WAKE, INT_MAX, nullptr, nullptr, 0);
}

}  // namespace manycore
