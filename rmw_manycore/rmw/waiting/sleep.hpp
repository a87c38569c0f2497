// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "rmw/waiting/waited.hpp"
#include "transport/waiting/joint_wait.hpp"

namespace rmw_manycore {

/// Where one call sleeps: on the platform of its wait set, and on those of entities of other
/// contexts, which few programs have. Changes of graph and events raise an epoch while somebody
/// watches; so only who waits for them is woken by them.
class Sleep {
public:
  Sleep(manycore::Waiter & own, const Waited & waited);
  ~Sleep();
  Sleep(const Sleep &) = delete;
  Sleep & operator=(const Sleep &) = delete;

  /// To be called before a look at the entities: what happens from then on ends `until` at once.
  void read_epochs() noexcept;
  /// True when something happened, false at `deadline_ns` (CLOCK_MONOTONIC; unset = no limit).
  bool until(std::optional<int64_t> deadline_ns);

private:
  void add(manycore::Waiter & waiter);
  void watch(manycore::Waiter & waiter) const noexcept;
  void unwatch(manycore::Waiter & waiter) const noexcept;

  manycore::Waiter & own_;
  uint32_t epoch_ = 0;
  std::vector<manycore::SeenEpoch> others_;
  const bool graph_;
  const bool events_;
};

}  // namespace rmw_manycore
