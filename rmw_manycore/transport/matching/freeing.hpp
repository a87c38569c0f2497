// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "transport/registry/block_in_hand.hpp"
#include "transport/registry/registry.hpp"

/// Decides when the memory of a closed endpoint can be freed, and takes it up block by block. The
/// caller holds the registry lock.
namespace manycore::freeing {

/// `none_left`: no memory is left to take up, so the slot can be given back once the hand is empty.
/// `some_left`: the hand is full. Others as in sweeping::Result.
enum class Progress { none_left, some_left, kept, in_use };

/// For an endpoint for whose state is_closed() holds. Throws ClusterUnmappable. A closed publisher
/// is freed unless orphans::cut() keeps it; `unwanted` as there.
Progress free_publisher(
  Registry & registry, uint32_t endpoint, BlockInHand & hand, std::vector<uint32_t> & unwanted);
Progress free_subscription(Registry & registry, uint32_t endpoint, BlockInHand & hand);

}  // namespace manycore::freeing
