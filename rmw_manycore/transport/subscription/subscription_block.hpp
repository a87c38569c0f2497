// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/layout/subscription_layout.hpp"
#include "transport/registry/registry.hpp"

namespace manycore::subscription_block {

/// Size of a subscription's header and queue.
uint64_t bytes_for(const Qos & qos) noexcept;

/// Fills in header and queue of a subscription: the spare block, if it has been made for that, or
/// else a new one in its cluster. The caller holds the registry lock. Throws
/// Error{no_space|corrupt}.
SubscriptionHeader & create(Registry & registry, uint32_t endpoint_slot, SpareBlock & spare);

}  // namespace manycore::subscription_block
