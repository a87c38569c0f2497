// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>

#include "platform/clock.hpp"

namespace manycore {

/// Sleeps of the middleware itself. They pass in wall time also in a run in virtual time, which
/// replaces the sleeps of libc: how often a lock is contended must not move its time.
inline void wall_sleep_until(int64_t until_ns) noexcept {
  const timespec until = to_timespec(until_ns);
  while (syscall(SYS_clock_nanosleep, CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) != 0 &&
         errno == EINTR) {
  }
}

inline void wall_sleep_for(std::chrono::nanoseconds duration) noexcept {
  wall_sleep_until(monotonic_ns() + duration.count());
}

}  // namespace manycore
