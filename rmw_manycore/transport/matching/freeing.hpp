// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/matching/turn.hpp"
#include "transport/matching/wanted_sources.hpp"
#include "transport/registry/registry.hpp"

namespace manycore::sweeping {

/// What came of one turn at an endpoint: its memory is free; a process may still be using it, or
/// wants what it holds; there is more to look at.
enum class Progress { freed, blocked, turn_over };

/// Both want a `closed` endpoint, or one that is `freeing`, and throw OutOfReach. They leave the
/// endpoint's slot to their caller.
Progress sweep_publisher(
  Registry & registry, WantedSources & wanted, EndpointEntry & entry, Turn & turn);
Progress sweep_subscription(Registry & registry, EndpointEntry & entry, Turn & turn);

}  // namespace manycore::sweeping
