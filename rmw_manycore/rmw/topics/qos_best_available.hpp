// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "rmw/context/node.hpp"
#include "rmw/types.h"

namespace rmw_manycore {

/// Replace "best available" policies by the highest level of service that matches the endpoints
/// that `topic` has now on the other side. Policies of other values are left as they are.
rmw_qos_profile_t best_available_for_subscription(
  const Node & node, const char * topic, const rmw_qos_profile_t & profile);
rmw_qos_profile_t best_available_for_publisher(
  const Node & node, const char * topic, const rmw_qos_profile_t & profile);
/// Services do not look at who is there.
rmw_qos_profile_t best_available_for_service(rmw_qos_profile_t profile);

}  // namespace rmw_manycore
