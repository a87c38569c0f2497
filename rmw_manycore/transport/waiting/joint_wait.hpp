// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "transport/waiting/waiter.hpp"

namespace manycore {

/// A waiter and the epoch last seen there.
struct SeenEpoch {
  Waiter * waiter;
  uint32_t epoch;
};

/// As Waiter::wait(), on several platforms at once: true when one of the epochs has changed, false
/// at `deadline_ns` (CLOCK_MONOTONIC; unset = no limit). Never spins, whatever the wait modes.
bool wait_for_any(const std::vector<SeenEpoch> & seen, std::optional<int64_t> deadline_ns);

}  // namespace manycore
