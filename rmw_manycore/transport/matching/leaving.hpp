// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/registry/registry.hpp"

namespace manycore {

/// What an endpoint's owner calls at its end: closes and sweeps, by as many holds of the registry
/// lock as it takes, and wakes the processes that watch the graph.
void leave_graph(Registry & registry, uint32_t endpoint) noexcept;

}  // namespace manycore
