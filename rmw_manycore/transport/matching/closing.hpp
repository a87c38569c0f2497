// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "transport/registry/registry.hpp"

namespace manycore::closing {

/// Removes an endpoint from the graph and undoes its matches; its memory is freed by sweeping. The
/// caller holds the registry lock. May be repeated after a caller died midway. `died`: the
/// endpoint's process is dead, so hints of its last records may not have been pushed. Appends to
/// `unread` the slots of publishers that are gone and may wait for no reader any more. Throws
/// ClusterUnmappable if this process cannot map the cluster of a match; the endpoint then stays
/// `closing`.
void close(Registry & registry, uint32_t endpoint, bool died, std::vector<uint32_t> & unread);

}  // namespace manycore::closing
