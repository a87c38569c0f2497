// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/notification/receive_thread.hpp"

#include "transport/queue/source_table.hpp"
#include "transport/registry/odd_phase.hpp"
#include "transport/topic_dsm/reader_table.hpp"

namespace manycore {

ReceiveThread::ReceiveThread(Registry & registry, uint32_t cluster)
: registry_(registry), cluster_(registry.clusters().at(cluster)), wakes_(registry) {
  cluster_.header().phase.store(0, std::memory_order_seq_cst);  // a dead predecessor's may be odd
}

void ReceiveThread::recover() {
  const Registry::Lock lock(registry_);
  for (uint32_t slot = 0; slot < registry_.endpoints().high_water(); ++slot) {
    EndpointEntry & endpoint = registry_.endpoints()[slot];
    if (
      !registry_.endpoints().is_live(slot) || endpoint.cluster != cluster_.id() ||
      endpoint.kind != EndpointKind::subscription) {
      continue;
    }
    if (auto * const header = cluster_.find<SubscriptionHeader>(endpoint.block.offset())) {
      header->resync.store(1, std::memory_order_seq_cst);
    }
  }
  wake_who_must_look();
}

/// Every write is atomic and of one size, so what is not a whole message of a known kind was put
/// there by a stranger. It may stand across messages, which then are unreadable as well.
bool ReceiveThread::handle(const EmcosMessage & message, const ProcessesChanged & on_change) {
  switch (message.kind) {
    case EmcosMessageKind::publish:
      forward(message);
      return true;
    case EmcosMessageKind::attach:
    case EmcosMessageKind::detach:
      on_change(message.kind);
      return true;
    case EmcosMessageKind::resync:  // take_overflow() follows
      return true;
  }
  return false;
}

void ReceiveThread::run(const ProcessesChanged & on_change) {
  ClusterHeader & header = cluster_.header();
  while (true) {
    const size_t bytes = cluster_.pipe().receive(batch_, sizeof batch_);
    const size_t count = bytes / sizeof(EmcosMessage);
    bool understood = bytes % sizeof(EmcosMessage) == 0;
    for (size_t i = 0; i < count && understood; ++i) {
      understood = handle(batch_[i], on_change);
    }
    header.messages.store(
      header.messages.load(std::memory_order_relaxed) + count, std::memory_order_relaxed);
    if (!understood) {
      recover();
      on_change(EmcosMessageKind::detach);  // its message may be among the unread
    }
    if (take_overflow()) {
      wake_who_must_look();
      on_change(EmcosMessageKind::attach);  // its message may be among the missing
    }
  }
}

/// The publisher's slot says so: the topic DSM may be gone, and what it says with it. Dekker with
/// the sweeper: the phase is stored before.
bool ReceiveThread::is_there(const EmcosMessage & message) const noexcept {
  if (message.endpoint >= registry_.endpoints().high_water()) {
    return false;
  }
  const Slot & publisher = registry_.endpoints()[message.endpoint].slot;
  return has_memory(publisher.state.load(std::memory_order_seq_cst)) &&
         publisher.incarnation.load(std::memory_order_seq_cst) == message.incarnation;
}

/// Step 2 of Fig. 4: receive thread -> queue -> wake.
void ReceiveThread::forward(const EmcosMessage & message) noexcept {
  const OddPhase phase(cluster_.header().phase);
  Cluster * const source = registry_.clusters().find(message.topic_dsm.cluster());
  TopicDsmHeader * const dsm =
    source == nullptr ? nullptr : source->find<TopicDsmHeader>(message.topic_dsm.offset());
  const bool current = dsm != nullptr && is_there(message) &&
                       dsm->magic.load(std::memory_order_relaxed) == topic_dsm_magic &&
                       dsm->endpoint.load(std::memory_order_relaxed) == message.endpoint &&
                       dsm->incarnation.load(std::memory_order_relaxed) == message.incarnation;
  if (current) {
    registry_.tracer().note(TraceKind::receive, message.endpoint, message.number, cluster_.id());
    while (!push_to_readers(*source, *dsm, message)) {
    }
    wakes_.flush();
  }
}

/// False when the reader table changed meanwhile: an entry may then have been read half old, half
/// new. What was pushed already is pushed twice; subscribers ignore doubles.
bool ReceiveThread::push_to_readers(
  const Cluster & source, TopicDsmHeader & dsm, const EmcosMessage & message) noexcept {
  const uint64_t generation = dsm.match_generation.load(std::memory_order_seq_cst);
  bool unchanged = true;
  visit_reader_table(source, dsm, [&](ReaderEntry & entry, uint32_t) {
    if (entry.active.load(std::memory_order_acquire) == 0) {
      return false;
    }
    // Acquire: who reads a value of a later reader finds the generation raised.
    const uint32_t endpoint = entry.endpoint.load(std::memory_order_acquire);
    const SegmentRef subscription{entry.subscription.load(std::memory_order_acquire)};
    const Hint hint{
      entry.source_index.load(std::memory_order_acquire),
      entry.source_incarnation.load(std::memory_order_acquire), message.number};
    unchanged = dsm.match_generation.load(std::memory_order_seq_cst) == generation;
    const bool wanted = message.target == nothing || message.target == endpoint;
    if (unchanged && wanted && subscription.cluster() == cluster_.id()) {
      push(subscription, hint, message);
    }
    return !unchanged;
  });
  return unchanged;
}

void ReceiveThread::push(SegmentRef ref, const Hint & hint, const EmcosMessage & message) noexcept {
  auto * const subscription = cluster_.find<SubscriptionHeader>(ref.offset());
  if (
    subscription == nullptr ||
    subscription->magic.load(std::memory_order_relaxed) != subscription_magic) {
    return;
  }
  registry_.tracer().note(
    TraceKind::hint, subscription->endpoint.load(std::memory_order_relaxed), message.number,
    trace_endpoint(message.endpoint, message.incarnation));
  const bool changes_events = subscriber_queue::push(*subscription, hint, [&](const Hint & oldest) {
    note_displaced(cluster_, *subscription, oldest);
  });
  ClusterHeader & header = cluster_.header();
  header.notifications.store(
    header.notifications.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  const uint32_t process = subscription->process.load(std::memory_order_relaxed);
  if (process < registry_.processes().high_water()) {
    const WakeWords & wake = registry_.processes()[process].wake;
    wakes_.add(process, wake.set_of(subscription->watchers, changes_events));
  }
}

/// After every batch: a sender that found the pipe full relies on the reader of the full pipe to
/// come by here.
bool ReceiveThread::take_overflow() noexcept {
  std::atomic<uint32_t> & overflow = cluster_.header().pipe_overflow;
  return overflow.load(std::memory_order_seq_cst) != 0 &&
         overflow.exchange(0, std::memory_order_seq_cst) != 0;
}

/// All processes of the cluster: who has nothing to look for sleeps on.
void ReceiveThread::wake_who_must_look() noexcept {
  for (uint32_t slot = 0; slot < registry_.processes().high_water(); ++slot) {
    if (
      registry_.processes().is_live(slot) && registry_.processes()[slot].cluster == cluster_.id()) {
      registry_.processes()[slot].wake.notify_all();
    }
  }
}

}  // namespace manycore
