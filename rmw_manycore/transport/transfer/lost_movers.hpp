// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/layout/subscription_layout.hpp"
#include "transport/layout/topic_dsm_layout.hpp"
#include "transport/registry/registry.hpp"

/// Sessions whose mover will not go on. The caller holds the registry lock.
namespace manycore::lost_movers {

/// False if what a subscription has not taken of a publisher that is gone never reaches it: the
/// last process of the publisher's cluster has gone, so no thread moves the records of its sessions
/// any more, and none of these has arrived. What a dead mover left without a hint, the subscription
/// is set to look for. `cluster`: that of the topic DSM. Throws ClusterUnmappable.
bool can_arrive(
  Registry & registry, const Cluster & cluster, TopicDsmHeader & dsm,
  SubscriptionHeader & subscription, uint32_t receiver, const SourceEntry & source);

}  // namespace manycore::lost_movers
