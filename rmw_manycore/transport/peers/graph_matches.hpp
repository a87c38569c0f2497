// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "transport/registry/graph.hpp"

namespace manycore {

/// For each endpoint of a snapshot, with how many others of it it is matched.
std::vector<uint64_t> count_matches(const std::vector<EndpointInfo> & endpoints);

}  // namespace manycore
