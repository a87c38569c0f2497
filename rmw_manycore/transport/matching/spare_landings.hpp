// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/matching/turn.hpp"
#include "transport/registry/membership.hpp"
#include "transport/registry/registry.hpp"

/// The landing that an endpoint makes for a match to come: its SMEM is reserved under the registry
/// lock and backed with memory without it. The endpoint's entry leads to it, so it is freed with
/// the endpoint if the process dies.
namespace manycore::spare_landings {

/// The landing that a match needs.
struct Needed {
  uint32_t cluster;
  uint64_t bytes;          ///< of the whole landing
  uint64_t cleared_bytes;  ///< of header and marks
};

/// Waits for another endpoint that is making a landing like the needed one: its match may be the
/// one that needs it. False if there is none, or it takes longer than five seconds.
bool await_another(Registry & registry, const SpareLanding & own, const Needed & needed);

/// Replaces the spare landing of a live endpoint of this process. Takes the registry lock. Throws
/// Error{no_space}, and the errors of `membership`.
void make(
  Registry & registry, const Membership & membership, SpareLanding & spare, const Needed & needed);

/// Frees a spare landing that no match has needed. Takes the registry lock.
void free_all(Registry & registry, const Membership & membership, SpareLanding & spare);

/// Frees pieces as the turn allows. True when none is left. The caller holds the registry lock.
/// Throws ClusterUnmappable.
bool free_some(Registry & registry, SpareLanding & spare, Turn & turn);

/// Rebuilding the maps of the clusters.
void mark(Clusters & clusters, const SpareLanding & spare) noexcept;

}  // namespace manycore::spare_landings
