// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/layout/subscription_layout.hpp"
#include "transport/registry/registry.hpp"

namespace manycore::subscription_block {

/// Allocates header and queue of a subscription in its cluster. The caller holds the registry lock.
/// Throws Error{no_space|corrupt}.
SubscriptionHeader & create(Registry & registry, uint32_t endpoint_slot);

}  // namespace manycore::subscription_block
