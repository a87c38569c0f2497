// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/qos/liveliness.hpp"

#include <algorithm>

#include "transport/peers/matches.hpp"
#include "transport/qos/manual_liveliness.hpp"
#include "virtual_time/door.hpp"

namespace manycore {
namespace {

/// Reads the registry only, because the topic DSM may be freed concurrently.
void add(
  const EndpointEntry & publisher, Liveliness kind, int64_t lease_ns, LivelinessCount & count) {
  if (kind == Liveliness::automatic) {
    ++count.alive;
    return;
  }
  // Read the clock before `asserted_ns`: if a stale value looks expired, the publisher, which reads
  // its clock after storing, finds the expiry too, and notifies.
  const int64_t now_ns = qos_now_ns();
  const int64_t asserted_ns = publisher.asserted_ns.load(std::memory_order_seq_cst);
  if (asserted_ns <= ManualLiveliness::never) {
    return;
  }
  if (now_ns - asserted_ns >= lease_ns) {
    ++count.not_alive;
    return;
  }
  ++count.alive;
  if (lease_ns <= infinite_ns - asserted_ns) {
    count.next_due_ns = std::min(count.next_due_ns, asserted_ns + lease_ns);
  }
}

}  // namespace

LivelinessCount liveliness_of(
  Registry & registry, const Matches & matches, int64_t requested_lease_ns) {
  LivelinessCount count;
  if (requested_lease_ns == infinite_ns) {
    count.alive = matches.matched().current;
    return count;
  }
  matches.for_each([&](const Peer & peer) {
    add(registry.endpoints()[peer.slot], peer.liveliness, requested_lease_ns, count);
  });
  count.not_alive += matches.died();
  return count;
}

}  // namespace manycore
