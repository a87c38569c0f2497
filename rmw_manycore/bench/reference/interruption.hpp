// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <thread>

#include "bench/rcl_node.hpp"

namespace manycore::bench::reference {

/// Blocks SIGINT and SIGTERM in this thread and those that it starts. Call before starting any
/// thread.
void block_interruptions();
/// True once one of the two signals has arrived.
bool is_interrupted();

/// Triggers a guard condition when one of the two signals arrives.
class Interruption {
public:
  explicit Interruption(RclContext & context);
  Interruption(const Interruption &) = delete;
  Interruption & operator=(const Interruption &) = delete;
  ~Interruption();

  const RclGuardCondition & guard_condition() const { return guard_condition_; }

private:
  RclGuardCondition guard_condition_;
  std::thread waiter_;
};

}  // namespace manycore::bench::reference
