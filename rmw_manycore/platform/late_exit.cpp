// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "platform/late_exit.hpp"

#include <unistd.h>

#include <thread>

#include "platform/blocked_signals.hpp"
#include "platform/wall_sleep.hpp"

namespace manycore {

void exit_after(std::chrono::nanoseconds delay, int status) {
  const BlockedSignals blocked;
  std::thread([=] {
    wall_sleep_for(delay);
    _exit(status);
  }).detach();
}

}  // namespace manycore
