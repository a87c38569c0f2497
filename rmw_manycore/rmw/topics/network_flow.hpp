// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "rmw/types.h"

namespace rmw_manycore {

/// Throws manycore::Error{unsupported} if unique network flow endpoints are strictly required.
void check_network_flow(rmw_unique_network_flow_endpoints_requirement_t requirement);

}  // namespace rmw_manycore
