// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/registry/registry.hpp"

namespace manycore::closing {

/// Ends all matches of an endpoint and takes it out of the graph; its memory goes with sweep().
/// All need the registry lock and are safe to repeat after their caller died half way. `died`: its
/// process is dead, so hints of its last records may never have been pushed. Throw OutOfReach while
/// this process cannot map the cluster of a match: the endpoint then stays `closing`.
void close(Registry & registry, uint32_t endpoint, bool died);
void close_all_of(Registry & registry, uint32_t process, bool died);

/// Frees what closed endpoints hold, as far as no process can be using it any more (see
/// docs/design/topic_dsm.md, Freeing), and closes what a living process could not, as a cluster was
/// out of its reach. False when something is out of this process's reach, and left to others.
bool sweep(Registry & registry);

/// What an endpoint's owner calls: takes the lock, closes, sweeps, and tells who watches the graph.
void leave(Registry & registry, uint32_t endpoint) noexcept;

}  // namespace manycore::closing
