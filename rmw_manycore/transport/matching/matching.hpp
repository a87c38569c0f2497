// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/registry/registry.hpp"

namespace manycore::matching {

/// Throws OutOfReach while this process cannot map the cluster of an endpoint with which a new one
/// may be matched: connect() would fail half way. Needs the registry lock.
void require_reach(Registry & registry, const std::string & topic, EndpointKind kind);

/// Joins a live endpoint with all compatible endpoints of its topic. Needs the registry lock.
void connect(Registry & registry, uint32_t endpoint);

/// After an owner of the registry lock died in connect(): takes back the match it left half made.
void undo_half_matches(Registry & registry);

/// After an owner of the registry lock died while counting: counts anew who is matched with how
/// many.
void recount(Registry & registry);

}  // namespace manycore::matching
