// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "platform/futex_any.hpp"

#include <algorithm>
#include <cerrno>
#include <ctime>

#include "platform/wall_sleep.hpp"

namespace manycore {
namespace {

constexpr long futex_waitv_number = 449;  // the same on all architectures except Alpha
constexpr int64_t poll_period_ns = 10'000'000;

}  // namespace

void futex_wait_any(std::vector<AwaitedWord> & words, std::optional<int64_t> deadline_ns) noexcept {
  const timespec until = to_timespec(deadline_ns.value_or(0));
  const long woken = syscall(
    futex_waitv_number, words.data(), words.size(), 0, deadline_ns ? &until : nullptr,
    CLOCK_MONOTONIC);
  if (woken < 0 && errno != EAGAIN && errno != EINTR && errno != ETIMEDOUT) {
    wall_sleep_until(std::min(deadline_ns.value_or(INT64_MAX), monotonic_ns() + poll_period_ns));
  }
}

}  // namespace manycore
