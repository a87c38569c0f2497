// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>

#include "rmw/types.h"
#include "transport/process.hpp"

namespace rmw_manycore {

/// rmw passes the entities to each wait, so a wait set only holds the process whose waiters it
/// uses.
class WaitSet {
public:
  explicit WaitSet(rmw_context_t & context);
  WaitSet(const WaitSet &) = delete;
  WaitSet & operator=(const WaitSet &) = delete;

  rmw_wait_set_t handle{};

  manycore::Waiters & waiters() const noexcept { return process_->waiters(); }
  manycore::Tracer & tracer() const noexcept { return process_->tracer(); }
  bool is_cut_off() const noexcept { return process_->is_cut_off(); }
  /// Throws manycore::Error if no notification could ever wake this process.
  void require_membership() const { process_->require_membership(); }
  bool is_shutdown() const noexcept { return *is_shutdown_; }

private:
  const std::shared_ptr<manycore::Process> process_;
  const std::shared_ptr<const std::atomic<bool>> is_shutdown_;
};

}  // namespace rmw_manycore
