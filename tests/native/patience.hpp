// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>

/// How long a test waits for what must come, before it calls it a hang. Far above what is needed on
/// a loaded machine with sanitizers: no test passes or fails by timing.
constexpr int patience_s = 60;

/// Looks until `predicate` holds. Throws naming `what` when it does not become true.
template<typename Predicate>
void wait_until(const std::string & what, Predicate predicate) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(patience_s);
  while (!predicate()) {
    if (std::chrono::steady_clock::now() > end) {
      throw std::runtime_error("not within " + std::to_string(patience_s) + " s: " + what);
    }
    std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
}
