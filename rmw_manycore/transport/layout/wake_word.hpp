// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "platform/futex.hpp"

namespace manycore {

/// What a process sleeps on. In the registry, one per process slot.
struct alignas(64) WakeWord {
  FutexWord epoch;
  std::atomic<uint32_t> sleepers;
  std::atomic<uint32_t> graph_watchers;
  std::atomic<uint32_t> event_watchers;

  /// Raises the epoch; one system call only if somebody sleeps.
  ///
  /// No wake-up is lost: the sleeper counts itself before the kernel compares the epoch, the waker
  /// raises the epoch before it looks at the count; both are seq_cst, so one of them sees the
  /// other.
  void notify() noexcept {
    epoch.fetch_add(1, std::memory_order_seq_cst);
    if (sleepers.load(std::memory_order_seq_cst) != 0) {
      futex_wake_all(epoch);
    }
  }
};
static_assert(sizeof(WakeWord) == 64);

}  // namespace manycore
