// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/layout/spare_block.hpp"
#include "transport/matching/turn.hpp"
#include "transport/registry/membership.hpp"
#include "transport/registry/registry.hpp"

/// A block for an endpoint or a match to come: its SMEM is reserved under the registry lock and
/// backed with memory without it. The entry of the process or of the endpoint leads to it, so it is
/// freed with these if the process dies.
namespace manycore::spare_blocks {

/// Larger blocks are backed, and freed, in more than one hold of the registry lock.
constexpr uint64_t max_bytes_at_once = 16 << 10;

/// The block that an endpoint or a match needs.
struct Needed {
  SpareUse use;
  uint32_t cluster;
  uint64_t bytes;          ///< of the whole block
  uint64_t cleared_bytes;  ///< from its beginning
};

/// Waits for another endpoint that is making a block like the needed one: its match may be the
/// one that needs it. False if there is none, or it takes longer than five seconds.
bool await_another(Registry & registry, const SpareBlock & own, const Needed & needed);

/// Replaces the spare block of this process, or of a live endpoint of it. Takes the registry lock.
/// Throws Error{no_space}, and the errors of `membership`.
void make(
  Registry & registry, const Membership & membership, SpareBlock & spare, const Needed & needed);

/// Frees a spare block that was not needed. Takes the registry lock.
void free_all(Registry & registry, const Membership & membership, SpareBlock & spare);

/// Frees pieces as the turn allows. True when none is left. The caller holds the registry lock.
/// Throws ClusterUnmappable.
bool free_some(Registry & registry, SpareBlock & spare, Turn & turn);

/// Rebuilding the maps of the clusters.
void mark(Clusters & clusters, const SpareBlock & spare) noexcept;

}  // namespace manycore::spare_blocks
