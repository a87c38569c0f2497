// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "rmw/context/node.hpp"
#include "rmw/types.h"

namespace rmw_manycore {

/// Replace each "best available" policy by the highest level of service that is compatible with the
/// current endpoints on the other side of `topic`. Other policies are unchanged.
rmw_qos_profile_t best_available_for_subscription(
  const Node & node, const char * topic, const rmw_qos_profile_t & profile);
rmw_qos_profile_t best_available_for_publisher(
  const Node & node, const char * topic, const rmw_qos_profile_t & profile);
/// For services, existing endpoints are not considered.
rmw_qos_profile_t best_available_for_service(rmw_qos_profile_t profile);

}  // namespace rmw_manycore
