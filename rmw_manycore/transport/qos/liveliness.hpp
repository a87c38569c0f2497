// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/registry/registry.hpp"

namespace manycore {

/// Who of a subscription's publishers is alive now. Any thread, without the registry lock.
///
/// AUTOMATIC publishers live as long as their process, which its lifeline proves; MANUAL_BY_TOPIC
/// ones for the subscription's lease after each assertion, and count as neither before the first. A
/// publisher whose process died is not alive, until another one takes its place (see
/// docs/design/qos_timing.md).
LivelinessCount liveliness_of(Registry & registry, const EndpointEntry & subscription);

/// The publisher's process died: to be called for each of its matches, under the registry lock.
void note_death(const EndpointEntry & publisher, EndpointEntry & subscription);
/// The subscription has a new publisher; under the registry lock.
void note_successor(EndpointEntry & subscription);

}  // namespace manycore
