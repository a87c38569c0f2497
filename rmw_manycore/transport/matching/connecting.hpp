// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/registry/membership.hpp"
#include "transport/registry/registry.hpp"

namespace manycore::matching {

/// Matches a new live endpoint of this process with all endpoints that are compatible. Takes the
/// registry lock anew after each block that is made for a match. Throws Error{no_space}, and the
/// errors of `membership`.
void connect(Registry & registry, const Membership & membership, uint32_t endpoint);

}  // namespace manycore::matching
