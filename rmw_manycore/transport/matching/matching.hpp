// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "transport/registry/registry.hpp"

namespace manycore::matching {

/// Throws OutOfReach while this process cannot map the cluster of an endpoint with which a new one
/// may be matched. Without the registry lock: some may come or go meanwhile.
void require_reach(Registry & registry, const std::string & topic, EndpointKind kind);

/// The endpoints that a live one has still to be matched with. Those that come later find it in the
/// graph and match themselves.
struct Candidate {
  uint32_t slot;
  uint32_t incarnation;
  uint32_t cluster;
};

/// All endpoints of its topic and of the other kind that are older. Without the registry lock,
/// unless endpoints leave the topic all the time. Throws OutOfReach while this process cannot map
/// the cluster of one: connect_some() would fail half way.
std::vector<Candidate> candidates_of(Registry & registry, uint32_t endpoint);

/// Joins a live endpoint with the last of the candidates that are compatible and still there, and
/// takes them off: as many as may be matched while others wait for the registry lock, which it
/// needs.
void connect_some(Registry & registry, uint32_t endpoint, std::vector<Candidate> & candidates);

/// After an owner of the registry lock died in connect(): takes back the match it left half made.
void undo_half_matches(Registry & registry);

/// After an owner of the registry lock died while counting: counts anew who is matched with how
/// many.
void recount(Registry & registry);

}  // namespace manycore::matching
