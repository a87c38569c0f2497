// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/layout/subscription_layout.hpp"
#include "transport/layout/topic_dsm_layout.hpp"
#include "transport/registry/registry.hpp"

namespace manycore {

/// What connecting and closing endpoints have in common. The caller holds the registry lock.

/// Counts behind an endpoint's matched and incompatible-QoS events; this and lost_so_far() need no
/// lock.
MatchedCount matched_of(const EndpointEntry & entry);
IncompatibleCount incompatible_of(const EndpointEntry & entry);

/// Messages that a subscription lost, as far as anybody can know: those that the publication
/// sequence numbers have shown to be missing, or what pushers have displaced since the subscriber
/// looked last, if that is more.
uint64_t lost_so_far(const EndpointEntry & entry, const SubscriptionHeader & header);

/// Wakes the threads that wait for a subscription's messages, or for events of a process.
void notify_watchers(Registry & registry, const SubscriptionHeader & header);
void notify_event_watchers(Registry & registry, uint32_t process);

/// The topic DSM of a source, or nullptr when its publisher's endpoint is gone and its memory may
/// be another's. Throws OutOfReach.
TopicDsmHeader * topic_dsm_of(Registry & registry, const SourceEntry & source);

}  // namespace manycore
