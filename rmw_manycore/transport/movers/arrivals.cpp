// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/movers/arrivals.hpp"

#include "transport/layout/subscription_layout.hpp"
#include "transport/notification/announced.hpp"
#include "transport/registry/odd_phase.hpp"

namespace manycore {
namespace {

/// Looks at the rows in the mover's phase, as the receive thread does.
void request_resyncs(Registry & registry, const Destination & to) noexcept {
  const EndpointEntry & publisher = registry.endpoints()[to.dsm.endpoint.load()];
  registry.walk_bucket(publisher.topic_hash, [&](uint32_t slot, uint32_t) {
    const EndpointEntry & entry = registry.endpoints()[slot];
    auto * const header = registry.endpoints().is_live(slot) &&
                              entry.kind == EndpointKind::subscription &&
                              entry.block.cluster() == to.receiver.id()
                            ? to.receiver.find<SubscriptionHeader>(entry.block.offset())
                            : nullptr;
    if (header != nullptr && header->magic.load() == subscription_magic) {
      header->resync.store(1, std::memory_order_seq_cst);
    }
    return true;
  });
  to.receiver.wake_resyncing();
}

}  // namespace

std::optional<Destination> destination_of(
  Registry & registry, const EmcosMessage & announcement, uint32_t receiver) noexcept {
  const Announced announced = Announced::find(registry, announcement);
  const Cluster * const to = registry.clusters().find(receiver);
  const bool is_there = announced && to != nullptr;
  const Landing landing =
    is_there ? Landing::of(*announced.source, *announced.dsm, *to) : Landing();
  if (!landing) {
    return std::nullopt;
  }
  return Destination{*announced.source, *announced.dsm, *to, landing};
}

bool is_awaited(const Destination & to, uint64_t number) noexcept {
  return number > to.landing.header().done.load(std::memory_order_relaxed) &&
         number <= to.dsm.last.load(std::memory_order_acquire);
}

void note_arrival(
  Registry & registry, const Destination & to, const EmcosMessage & announcement) noexcept {
  registry.tracer().note(
    TraceKind::arrive, announcement.endpoint, announcement.number, to.receiver.id());
  to.landing.arrive(announcement.number);
  if (!to.receiver.send(announcement)) {
    request_resyncs(registry, to);
  }
}

void note_loss(Registry & registry, const Destination & to, uint64_t number) noexcept {
  registry.tracer().note(
    TraceKind::drop, to.dsm.endpoint.load(std::memory_order_relaxed), number, to.receiver.id());
  to.landing.give_up(number);
  request_resyncs(registry, to);
}

/// A record that is handed over meanwhile, for a slot already passed, is in the pipe.
HandedBefore HandedBefore::look(Registry & registry, Transfer kind, uint32_t cluster) {
  HandedBefore before;
  for (uint32_t slot = 0; slot < registry.endpoints().high_water(); ++slot) {
    if (registry.endpoints()[slot].transfer == kind) {
      const Registry::Lock lock(registry);  // prevents freeing of topic DSMs
      before.look_at(registry, slot, kind, cluster);
    }
  }
  return before;
}

void HandedBefore::look_at(Registry & registry, uint32_t slot, Transfer kind, uint32_t cluster) {
  const EndpointEntry & entry = registry.endpoints()[slot];
  const bool is_message = kind == Transfer::message;
  if (
    entry.kind != EndpointKind::publisher || entry.transfer != kind ||
    !(is_message || entry.cluster == cluster) || !has_memory(entry.slot.state.load())) {
    return;
  }
  EmcosMessage announcement{};
  announcement.kind = EmcosMessageKind::publish;
  announcement.target = nothing;
  announcement.topic_dsm = entry.block;
  announcement.endpoint = slot;
  announcement.incarnation = entry.slot.incarnation.load();
  for (uint32_t receiver = 1; receiver <= max_clusters; ++receiver) {
    const bool is_present = (registry.header().clusters_present.load() >> (receiver - 1) & 1) != 0;
    if (!is_present || (is_message && receiver != cluster)) {
      continue;
    }
    if (const auto to = destination_of(registry, announcement, receiver)) {
      announcement.number = to->landing.header().handed.load(std::memory_order_seq_cst);
      entries_.push_back({announcement, receiver});
      if (!is_message) {
        // What the dead mover did not announce. Before a later record is: a hint to that would have
        // readers skip it. For the own cluster the receive thread has asked already.
        request_resyncs(registry, *to);
      }
    }
  }
}

void HandedBefore::give_up_missing(Registry & registry, std::atomic<uint64_t> & phase) noexcept {
  for (const Entry & entry : entries_) {
    const OddPhase odd(phase);
    const auto to = destination_of(registry, entry.announcement, entry.receiver);
    const uint64_t number = entry.announcement.number;
    if (!to || number == no_record) {
      continue;
    }
    const bool is_here = to->landing.has(number);
    const bool is_done = to->landing.header().done.load() >= number;
    if (!is_done && is_here) {
      note_arrival(registry, *to, entry.announcement);  // it was marked, and no more
    } else if (!is_done) {
      note_loss(registry, *to, number);
    } else if (!is_here) {
      request_resyncs(registry, *to);  // a later record may have ended it without telling them
    }
  }
  entries_.clear();
}

}  // namespace manycore
