// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// Part of transfer.hpp: the configured kind.
#include "platform/error.hpp"
#include "transport/transfer/transfer.hpp"

namespace manycore::transfer {

Transfer kind_of(const TopicEntry * configured, const EndpointSpec & spec, EndpointKind kind) {
  if (configured == nullptr || spec.role != EndpointRole::topic) {
    return Transfer::dsm;
  }
  const Transfer transfer = configured->transfer.kind;
  const bool keeps_history =
    kind == EndpointKind::publisher && spec.qos.durability == Durability::transient_local;
  if (transfer != Transfer::dsm && keeps_history) {
    throw Error(
      ErrorCode::unsupported,
      "a publisher of '" + spec.topic +
        "' wants durability transient_local, and the topic is transferred: later subscriptions in "
        "other clusters would not get its history. Expected durability volatile, or no 'transfer' "
        "for the topic in the mapfile");
  }
  return transfer;
}

}  // namespace manycore::transfer
