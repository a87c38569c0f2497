// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/registry/registry.hpp"

namespace manycore {

/// Closes and sweeps an endpoint for its owner, and wakes the processes that watch the graph.
void leave_graph(Registry & registry, uint32_t endpoint) noexcept;

/// Closes all endpoints of a process that creates no more of them, each in a hold of the registry
/// lock of its own, while `may_go_on` returns true under the lock. False if it did not. `died`: see
/// closing::close(). Throws ClusterUnmappable, once all others are closed, if an endpoint could not
/// be.
bool close_endpoints_of(
  Registry & registry, uint32_t process, bool died, const std::function<bool()> & may_go_on);

}  // namespace manycore
