// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "transport/registry/membership.hpp"
#include "transport/registry/registry.hpp"

namespace manycore::joining {

/// Throws ClusterUnmappable if this process cannot map the cluster of an endpoint with which a new
/// endpoint may be matched. Takes no registry lock, so endpoints may be added or removed
/// concurrently.
void require_reach(Registry & registry, const std::string & topic, EndpointKind kind);

/// After the endpoint's row is live, so that of two that are created at a time at least one finds
/// the other: wakes the processes of its peers that wait for events, and makes the room that a
/// transferred topic needs in other clusters. No memory of a peer is accessed. Throws
/// Error{no_space}, and the errors of `membership`.
void join(Registry & registry, const Membership & membership, uint32_t endpoint);

}  // namespace manycore::joining
