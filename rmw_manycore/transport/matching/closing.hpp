// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "transport/registry/registry.hpp"

namespace manycore::closing {

/// Takes an endpoint out of the graph and ends some of its matches: as many as the registry lock,
/// which the caller holds, may be held for. True when all have ended; its memory goes with
/// sweeping. Safe to repeat after its caller died half way. `died`: the endpoint's process is dead,
/// so hints of its last records may never have been pushed. Throws OutOfReach while this process
/// cannot map the cluster of a match: the endpoint then stays `closing`.
bool close_some(Registry & registry, uint32_t endpoint, bool died);

/// Closes all endpoints of a process that makes no more, piece by piece: the caller takes the
/// registry lock anew for each.
class EndpointsOfProcess {
public:
  EndpointsOfProcess(Registry & registry, uint32_t process, bool died) noexcept
  : registry_(registry), process_(process), died_(died) {}

  /// True when all were come to.
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
