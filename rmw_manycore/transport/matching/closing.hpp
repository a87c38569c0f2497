// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "transport/registry/registry.hpp"

namespace manycore::closing {

/// Removes an endpoint from the graph; its memory is freed by sweeping. The caller holds the
/// registry lock. Does nothing if the row is closed: a sweep goes on where a caller died midway,
/// and a repair wakes its peers. `died`: the endpoint's process is dead. Appends to `unwanted` the
/// slots of closed publishers that may wait for no reader any more. Throws ClusterUnmappable before
/// anything is changed if this process cannot map the endpoint's cluster; endpoints of other
/// clusters that it cannot reach are notified by the next sweep.
void close(Registry & registry, uint32_t endpoint, bool died, std::vector<uint32_t> & unwanted);

}  // namespace manycore::closing
