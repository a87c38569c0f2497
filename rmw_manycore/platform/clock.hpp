// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ctime>

#include <cstdint>

namespace manycore {

constexpr int64_t ns_per_s = 1'000'000'000;

inline int64_t clock_ns(clockid_t clock) noexcept {
  timespec t{};
  clock_gettime(clock, &t);
  return t.tv_sec * ns_per_s + t.tv_nsec;
}

/// Clock of deadlines and waits.
inline int64_t monotonic_ns() noexcept { return clock_ns(CLOCK_MONOTONIC); }

/// Clock of message timestamps.
inline int64_t realtime_ns() noexcept { return clock_ns(CLOCK_REALTIME); }

inline timespec to_timespec(int64_t ns) noexcept {
  return {static_cast<time_t>(ns / ns_per_s), static_cast<long>(ns % ns_per_s)};
}

}  // namespace manycore
