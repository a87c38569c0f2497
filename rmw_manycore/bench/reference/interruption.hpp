// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <rcl/rcl.h>

#include <thread>

#include "bench/rcl_node.hpp"

namespace manycore::bench::reference {

/// Blocks SIGINT and SIGTERM in this thread and those it starts: call it before any is started.
void block_interruptions();
/// Whether one of the two has come.
bool is_interrupted();

/// Triggers a guard condition when one of the two comes.
class Interruption {
public:
  explicit Interruption(RclContext & context);
  Interruption(const Interruption &) = delete;
  Interruption & operator=(const Interruption &) = delete;
  ~Interruption();

  const rcl_guard_condition_t & guard_condition() const { return guard_condition_; }

private:
  rcl_guard_condition_t guard_condition_ = rcl_get_zero_initialized_guard_condition();
  std::thread waiter_;
};

}  // namespace manycore::bench::reference
