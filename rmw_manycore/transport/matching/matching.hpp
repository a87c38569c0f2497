// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "transport/matching/spare_blocks.hpp"
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

/// Matches a live endpoint with the compatible and live ones among the last candidates, and removes
/// these from the list, until the turn is over or a match needs a block that the endpoint has to
/// make first. Returns that block. The caller holds the registry lock.
std::optional<spare_blocks::Needed> connect_some(
  Registry & registry, uint32_t endpoint, std::vector<Candidate> & candidates);

}  // namespace manycore::matching
