// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/peers/matches.hpp"

namespace manycore {

/// Counts a subscription's publishers by liveliness. Thread-safe, without the registry lock.
///
/// An AUTOMATIC publisher is alive while its process lives, which the lifeline proves. A
/// MANUAL_BY_TOPIC publisher is alive for the subscription's lease after each assertion, and counts
/// as neither before the first. A publisher whose process died is not alive until a new publisher
/// is matched in its place (see docs/design/qos_timing.md).
LivelinessCount liveliness_of(
  Registry & registry, const Matches & matches, int64_t requested_lease_ns);

}  // namespace manycore
