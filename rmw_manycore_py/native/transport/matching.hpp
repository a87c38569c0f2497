// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/registry.hpp"

namespace manycore::matching {

/// Joins a live endpoint with all compatible endpoints of its topic. All functions here need the registry
/// lock; all are safe to repeat after their caller died half way.
void connect(Registry & registry, uint32_t endpoint);

/// After an owner of the registry lock died in connect(): takes back the match it left half made.
void undo_half_matches(Registry & registry);

/// Ends all matches of an endpoint and takes it out of the graph; its memory goes with sweep().
/// `died`: its process is dead, so hints of its last records may never have been pushed.
void close(Registry & registry, uint32_t endpoint, bool died);

/// Frees what closing endpoints hold, as far as nobody can be using it any more.
void sweep(Registry & registry);

}  // namespace manycore::matching
