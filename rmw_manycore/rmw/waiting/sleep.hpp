// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "rmw/waiting/waited.hpp"
#include "transport/waiting/joint_wait.hpp"

namespace rmw_manycore {

/// The waiters that one rmw_wait() call sleeps on: the thread's wake word on the platform of the
/// wait set, and on the platforms of entities of other contexts, which are rare.
class Sleep {
public:
  Sleep(manycore::Waiters & own, const Waited & waited);
  Sleep(const Sleep &) = delete;
  Sleep & operator=(const Sleep &) = delete;

  /// Registers the thread as a watcher of all entities.
  void watch() noexcept;
  /// As watch(), after removing the thread from all watchers. Call after a spurious wake-up.
  void watch_afresh() noexcept;
  /// Call before checking the entities: anything that happens afterwards ends until() at once.
  void read_epochs() noexcept;
  /// True if something happened, false at `deadline_ns` (CLOCK_MONOTONIC; unset = no limit).
  bool until(std::optional<int64_t> deadline_ns);

private:
  struct Other {
    manycore::Waiters * waiters;
    uint32_t epoch;
  };

  void add(manycore::Waiters & waiters);

  manycore::Waiters & own_;
  const Waited & waited_;
  uint32_t epoch_ = 0;
  std::vector<Other> others_;
};

}  // namespace rmw_manycore
