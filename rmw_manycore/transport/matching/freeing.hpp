// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/matching/turn.hpp"
#include "transport/matching/wanted_sources.hpp"
#include "transport/registry/registry.hpp"

namespace manycore::sweeping {

/// What came of one turn at an endpoint: its memory is free; a process may still be using it, or
/// wants what it holds; there is more to look at.
enum class Progress { freed, blocked, turn_over };

/// One look at all readers of a topic DSM, in as many turns as it takes. The first of them goes on
/// where the last turn of any process ended; readers before that may be done by now, so the look
/// then comes to them at last.
struct ReaderPass {
  uint32_t endpoint = nothing;  ///< slot of the publisher
  bool began_first = false;     ///< all readers were looked at since, once it comes to the last
};

/// Both want a `closed` endpoint, or one that is `freeing`, and throw OutOfReach. They leave the
/// endpoint's slot to their caller.
Progress sweep_publisher(
  Registry & registry, WantedSources & wanted, ReaderPass & pass, uint32_t endpoint, Turn & turn);
Progress sweep_subscription(Registry & registry, EndpointEntry & entry, Turn & turn);

}  // namespace manycore::sweeping
