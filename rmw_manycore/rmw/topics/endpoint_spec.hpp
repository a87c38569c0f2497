// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "rmw/context/node.hpp"
#include "rmw/qos/qos.hpp"
#include "transport/layout/endpoint.hpp"

namespace rmw_manycore {

/// Parameters of one endpoint of `node`. QoS as in to_transport().
template<typename Type>
manycore::EndpointSpec endpoint_spec(
  const Node & node, manycore::EndpointRole role, const char * topic, const Type & type,
  const rmw_qos_profile_t & profile, manycore::EndpointKind kind) {
  manycore::EndpointSpec spec;
  spec.node = node.registered();
  spec.role = role;
  spec.topic = topic;
  spec.type = type.name;
  spec.type_hash = type.hash;
  spec.qos = to_transport(profile, kind);
  return spec;
}

}  // namespace rmw_manycore
