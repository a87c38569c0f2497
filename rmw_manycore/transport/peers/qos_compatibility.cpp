// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/peers/qos_compatibility.hpp"

namespace manycore {

QosPolicy last_incompatible_policy(const Qos & offered, const Qos & requested) {
  if (offered.reliability < requested.reliability) {
    return QosPolicy::reliability;
  }
  if (
    offered.liveliness < requested.liveliness ||
    offered.liveliness_lease_ns > requested.liveliness_lease_ns) {
    return QosPolicy::liveliness;
  }
  if (offered.deadline_ns > requested.deadline_ns) {
    return QosPolicy::deadline;
  }
  if (offered.durability < requested.durability) {
    return QosPolicy::durability;
  }
  return QosPolicy::none;
}

}  // namespace manycore
