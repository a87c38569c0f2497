// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/qos/liveliness.hpp"

#include <algorithm>

#include "platform/clock.hpp"
#include "transport/qos/manual_liveliness.hpp"
#include "transport/queue/source_table.hpp"

namespace manycore {
namespace {

/// The live publisher of a source, or nullptr. Reads the registry only, because the topic DSM may
/// be freed concurrently.
const EndpointEntry * publisher_of(Registry & registry, const SourceEntry & source) {
  const uint32_t slot = source.topic_dsm_endpoint.load(std::memory_order_relaxed);
  if (
    source.state.load(std::memory_order_acquire) != SourceState::active ||
    !registry.endpoints().is_live(slot)) {
    return nullptr;
  }
  const EndpointEntry & entry = registry.endpoints()[slot];
  return entry.slot.incarnation == source.topic_dsm_incarnation.load(std::memory_order_relaxed)
           ? &entry
           : nullptr;
}

void add(const EndpointEntry & publisher, int64_t lease_ns, LivelinessCount & count) {
  if (publisher.qos.liveliness == Liveliness::automatic) {
    ++count.alive;
    return;
  }
  // Before the assertion is loaded: if that is out of date, and found to have run out, the clock of
  // the publisher, which reads it after its store, says so too, and the publisher notifies.
  const int64_t now_ns = monotonic_ns();
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

LivelinessCount liveliness_of(Registry & registry, const EndpointEntry & subscription) {
  LivelinessCount count;
  const int64_t lease_ns = subscription.qos.liveliness_lease_ns;
  if (lease_ns == infinite_ns) {
    count.alive = subscription.matched_current.load();
    return count;
  }
  Cluster * const cluster = registry.clusters().find(subscription.block.cluster());
  auto * const header = registry.clusters().find<SubscriptionHeader>(subscription.block);
  count.not_alive = subscription.dead_publishers.load();
  if (cluster != nullptr && header != nullptr) {
    visit_source_table(*cluster, *header, [&](SourceEntry & source, uint32_t) {
      if (const EndpointEntry * const publisher = publisher_of(registry, source)) {
        add(*publisher, lease_ns, count);
      }
      return false;
    });
  }
  return count;
}

void note_death(const EndpointEntry & publisher, EndpointEntry & subscription) {
  const bool was_known_alive = publisher.qos.liveliness == Liveliness::automatic ||
                               publisher.asserted_ns.load() != ManualLiveliness::never;
  if (was_known_alive && subscription.qos.liveliness_lease_ns != infinite_ns) {
    subscription.dead_publishers.fetch_add(1);
  }
}

void note_successor(EndpointEntry & subscription) {
  if (subscription.dead_publishers.load() != 0) {
    subscription.dead_publishers.fetch_sub(1);
  }
}

}  // namespace manycore
