// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/layout/endpoint.hpp"
#include "transport/registry/block_in_hand.hpp"
#include "transport/registry/membership.hpp"
#include "transport/registry/registry.hpp"

namespace manycore {

/// Takes a slot of the endpoint table for a process and fills it in. The endpoint is not live yet
/// and has no block. The caller holds the registry lock. Throws
/// Error{no_space|invalid_argument|corrupt}.
uint32_t new_endpoint(
  Registry & registry, const EndpointSpec & spec, EndpointKind kind, uint32_t process);

/// Creates an endpoint of a process with its block, live and in the chain of its topic. `hand` has
/// the block of a large queue, else nullptr. Takes the registry lock. Throws as new_endpoint(), and
/// Error{system} if the process is no member any more.
uint32_t enter_graph(
  Registry & registry, const Membership & membership, const EndpointSpec & spec, EndpointKind kind,
  uint32_t process, BlockInHand * hand);

}  // namespace manycore
