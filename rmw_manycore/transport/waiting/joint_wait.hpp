// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "transport/waiting/waiter.hpp"

namespace manycore {

/// Where to sleep, and the epoch that was seen there.
struct SeenEpoch {
  Waiter * waiter;
  uint32_t epoch;
};

/// As Waiter::wait, on several platforms at once: true when one of the epochs is no longer the seen
/// one, false at `deadline_ns`. Never spins, whatever the wait modes are.
bool wait_for_any(const std::vector<SeenEpoch> & seen, std::optional<int64_t> deadline_ns);

}  // namespace manycore
