// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "transport/registry/block_in_hand.hpp"
#include "transport/registry/registry.hpp"

namespace manycore::matching {

/// Throws ClusterUnmappable if this process cannot map the cluster of an endpoint with which a new
/// endpoint may be matched. Takes no registry lock, so endpoints may be added or removed
/// concurrently.
void require_reach(Registry & registry, const std::string & topic, EndpointKind kind);

/// An older endpoint that a new one may be matched with. Younger endpoints find the new one in the
/// graph and match themselves.
struct Candidate {
  uint32_t slot;
  uint32_t incarnation;
  uint32_t cluster;
};

/// All older endpoints of the same topic and the other kind. Needs no lock. Throws
/// ClusterUnmappable if this process cannot map the cluster of a candidate, because connect_some()
/// would fail midway.
std::vector<Candidate> candidates_of(Registry & registry, uint32_t endpoint);

/// Matches a live endpoint with the compatible and live ones among the candidates, the last ones
/// first, and removes them from the list, until a match needs a block that has to be in hand first.
/// Returns that block. `hand`: nullptr = empty. The caller holds the registry lock.
std::optional<NeededBlock> connect_some(
  Registry & registry, uint32_t endpoint, std::vector<Candidate> & candidates, BlockInHand * hand);

}  // namespace manycore::matching
