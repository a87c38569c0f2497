// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "rmw/waiting/waited.hpp"
#include "transport/waiting/joint_wait.hpp"

namespace rmw_manycore {

/// Where one call sleeps: on its thread's wake word of the platform of its wait set, and on those
/// of the platforms of entities of other contexts, which few programs have.
class Sleep {
public:
  Sleep(manycore::Waiters & own, const Waited & waited);
  Sleep(const Sleep &) = delete;
  Sleep & operator=(const Sleep &) = delete;

  /// From here on all that is waited for raises the epochs.
  void watch() noexcept;
  /// As watch, and what is not waited for no longer does: after a wake-up for nothing.
  void watch_afresh() noexcept;
  /// To be called before a look at the entities: what happens from then on ends `until` at once.
  void read_epochs() noexcept;
  /// True when something happened, false at `deadline_ns` (CLOCK_MONOTONIC; unset = no limit).
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
