// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "rmw/types.h"
#include "transport/layout/endpoint.hpp"

namespace rmw_manycore {

/// Resolves system defaults as rmw_fastrtps_cpp does (publishers: reliable and transient local;
/// subscriptions: best effort and volatile; depth 1). Throws manycore::Error{invalid_argument} for
/// an invalid policy, including MANUAL_BY_NODE, which ROS 2 has removed.
manycore::Qos to_transport(const rmw_qos_profile_t & profile, manycore::EndpointKind kind);

rmw_qos_profile_t to_rmw(const manycore::Qos & qos);

}  // namespace rmw_manycore
