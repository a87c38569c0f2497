// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "transport/matching/turn.hpp"
#include "transport/registry/registry.hpp"

namespace manycore::closing {

/// Takes an endpoint out of the graph and ends its matches, as many as the turn allows; the caller
/// holds the registry lock. True when all have ended; the endpoint's memory goes with sweeping.
/// Safe to repeat after its caller died half way. `died`: the endpoint's process is dead, so hints
/// of its last records may never have been pushed. Throws OutOfReach while this process cannot map
/// the cluster of a match: the endpoint then stays `closing`.
bool close_some(Registry & registry, uint32_t endpoint, bool died, Turn & turn);

/// Closes all endpoints of a process that makes no more, turn by turn: the caller takes the
/// registry lock anew for each.
class EndpointsOfProcess {
public:
  EndpointsOfProcess(Registry & registry, uint32_t process, bool died) noexcept
  : registry_(registry), process_(process), died_(died) {}

  /// One turn. True when all were come to.
  bool close_some();
  /// Throws OutOfReach unless all are closed.
  void require_all_closed();

private:
  Registry & registry_;
  const uint32_t process_;
  const bool died_;
  uint32_t next_ = 0;  ///< those of its endpoints below this slot are closed
  std::optional<OutOfReach> obstacle_;
};

}  // namespace manycore::closing
