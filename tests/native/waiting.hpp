// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>

/// Time after which a test considers a wait as hanging. Far above what a loaded machine with
/// sanitizers needs: no test passes or fails by timing.
constexpr int timeout_s = 60;

/// Polls until `predicate` holds. Throws naming `what` if it does not become true.
template<typename Predicate>
void wait_until(const std::string & what, Predicate predicate) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(timeout_s);
  while (!predicate()) {
    if (std::chrono::steady_clock::now() > end) {
      throw std::runtime_error("not within " + std::to_string(timeout_s) + " s: " + what);
    }
    std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
}
