// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "transport/matching/turn.hpp"
#include "transport/registry/slots_of_process.hpp"

namespace manycore::closing {

/// Removes an endpoint from the graph and undoes its matches until the turn is over. True when all
/// are undone; the endpoint's memory is freed by sweeping. The caller holds the registry lock. May
/// be repeated after a caller died midway. `died`: the endpoint's process is dead, so hints of its
/// last records may not have been pushed. Throws ClusterUnmappable if this process cannot map the
/// cluster of a match; the endpoint then stays `closing`. `unread`: gets the slots of publishers
/// that are gone, and whose last reader the endpoint was.
bool close_some(
  Registry & registry, uint32_t endpoint, bool died, Turn & turn,
  std::vector<uint32_t> * unread = nullptr);

/// Closes all endpoints of a process that creates no more of them, turn by turn. The caller takes
/// the registry lock anew for each turn.
class EndpointsOfProcess {
public:
  /// Finds the endpoints without the registry lock.
  EndpointsOfProcess(Registry & registry, uint32_t process, bool died)
  : registry_(registry),
    process_(process),
    died_(died),
    left_(slots_of_process(registry.endpoints(), process)) {}

  /// Closes as many endpoints as the turn allows. Returns true when all have been visited.
  bool close_some(Turn & turn);
  /// Throws ClusterUnmappable if an endpoint could not be closed.
  void require_all_closed();

private:
  Registry & registry_;
  const uint32_t process_;
  const bool died_;
  std::vector<uint32_t> left_;  ///< slots not visited yet
  std::optional<ClusterUnmappable> obstacle_;
};

}  // namespace manycore::closing
