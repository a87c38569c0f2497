// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/registry/registry.hpp"

namespace manycore {

/// Closes and sweeps an endpoint for its owner, taking the registry lock as often as needed, and
/// wakes the processes that watch the graph.
void leave_graph(Registry & registry, uint32_t endpoint) noexcept;

}  // namespace manycore
