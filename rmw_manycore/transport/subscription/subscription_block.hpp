// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/layout/subscription_layout.hpp"
#include "transport/registry/block_in_hand.hpp"
#include "transport/registry/registry.hpp"

namespace manycore::subscription_block {

/// Size of a subscription's header and queue.
uint64_t bytes_for(const Qos & qos) noexcept;

/// The block in hand, if the queue is large.
NeededBlock block_for(const Qos & qos, uint32_t cluster) noexcept;

/// Fills in header and queue of a subscription: in the block in hand, or a new one in its cluster.
/// The caller holds the registry lock. Throws Error{no_space|corrupt}.
SubscriptionHeader & create(Registry & registry, uint32_t endpoint_slot, BlockInHand * hand);

}  // namespace manycore::subscription_block
