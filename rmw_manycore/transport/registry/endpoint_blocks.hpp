// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/layout/subscription_layout.hpp"
#include "transport/layout/topic_dsm_layout.hpp"
#include "transport/registry/registry.hpp"

namespace manycore {

/// Operations shared by matching and closing. The caller holds the registry lock unless stated
/// otherwise.

/// True if a newer message takes the place of one that the subscription has not taken.
bool keeps_newest_only(const EndpointEntry & subscription) noexcept;

/// Messages that a subscription has not taken; see EndpointCounters.
struct Missed {
  uint64_t lost;
  uint64_t superseded;
};

/// As far as is known: those found missing by publication sequence number, or the hints displaced
/// since the subscriber last checked, whichever is more. `displaced`:
/// SubscriptionHeader::displaced() of now.
Missed missed_so_far(
  const EndpointEntry & entry, const SubscriptionHeader & header, uint64_t displaced) noexcept;

/// Wakes threads that wait for messages of the subscription, or for events of the process.
void notify_watchers(Registry & registry, const SubscriptionHeader & header);
void notify_event_watchers(Registry & registry, uint32_t process);

}  // namespace manycore
