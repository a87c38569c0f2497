// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/matching/turn.hpp"
#include "transport/matching/wanted_sources.hpp"
#include "transport/registry/registry.hpp"

namespace manycore::sweeping {

/// Result of one turn at an endpoint. `freed`: all its memory is freed. `freed_some`: the turn
/// ended after a part was freed. `kept`: a reader wants the content and sweeps after its last take,
/// or the endpoint is not closed yet. `in_use`: another process is accessing the memory at the
/// moment and need not sweep afterwards, so some process has to look again. `turn_over`: the turn
/// ended with work left.
enum class Progress { freed, freed_some, kept, in_use, turn_over };

/// A pass over all readers of a topic DSM, in as many turns as needed. Its first turn continues
/// where the last turn of any process ended. Earlier readers may have finished since, so the pass
/// starts over once at the first reader.
struct ReaderPass {
  uint32_t endpoint = nothing;  ///< publisher's slot
  bool began_first = false;     ///< the pass has started at the first reader
  bool is_any_in_use = false;   ///< a reader was `in_use`
};

/// Free the memory of an endpoint for whose state is_closed() holds; the caller frees its slot.
/// Throw ClusterUnmappable.
Progress sweep_publisher(
  Registry & registry, WantedSources & wanted, ReaderPass & pass, uint32_t endpoint, Turn & turn);
Progress sweep_subscription(Registry & registry, EndpointEntry & entry, Turn & turn);

}  // namespace manycore::sweeping
