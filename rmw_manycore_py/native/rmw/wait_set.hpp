// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "rmw/types.h"
#include "transport/process.hpp"

namespace rmw_manycore {

/// rmw hands the entities to each wait, so a wait set only knows where its process sleeps.
class WaitSet {
public:
  explicit WaitSet(rmw_context_t & context);
  WaitSet(const WaitSet &) = delete;
  WaitSet & operator=(const WaitSet &) = delete;

  rmw_wait_set_t handle{};

  manycore::Waiter & waiter() const noexcept { return process_->waiter(); }

private:
  const std::shared_ptr<manycore::Process> process_;
};

}  // namespace rmw_manycore
