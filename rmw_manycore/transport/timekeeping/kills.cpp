// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// Part of Timekeeper: programs that are killed at a time of the run.

#include <poll.h>

#include "platform/os_process.hpp"
#include "transport/timekeeping/timekeeper.hpp"

namespace manycore {

/// Kills the program that is due first, and waits for its end: so it dies at this time. Reported
/// before, so that the run knows why it ended.
void Timekeeper::kill_due() {
  const uint32_t rank = kills_.begin()->second;
  kills_.erase(kills_.begin());
  report("killed", std::to_string(rank));
  for (const auto & [_, process] : programs_.at(rank).processes) {
    kill_process(process.pidfd);
    pollfd ended{process.pidfd.get(), POLLIN, 0};
    constexpr int at_most_ms = 2000;
    poll(&ended, 1, at_most_ms);
  }
}

}  // namespace manycore
