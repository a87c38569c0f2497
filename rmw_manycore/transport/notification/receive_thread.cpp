// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/notification/receive_thread.hpp"

#include "transport/notification/announced.hpp"
#include "transport/queue/source_table.hpp"
#include "transport/registry/odd_phase.hpp"
#include "transport/topic_dsm/reader_table.hpp"

namespace manycore {
namespace {

/// Entry of the only reader to notify, or nullptr if it is not where the message says: the table
/// changed since the message was sent, or there are several readers.
const ReaderEntry * target_of(
  const Cluster & source, TopicDsmHeader & dsm, const EmcosMessage & message) noexcept {
  const ReaderEntry * const entry =
    message.target == nothing ? nullptr : find_reader(source, dsm, message.target_index);
  const bool is_there = entry != nullptr && entry->active.load(std::memory_order_acquire) != 0 &&
                        entry->endpoint.load(std::memory_order_acquire) == message.target;
  return is_there ? entry : nullptr;
}

}  // namespace

ReceiveThread::ReceiveThread(Registry & registry, uint32_t cluster)
: registry_(registry), cluster_(registry.clusters().at(cluster)), wakes_(registry) {
  // A dead predecessor may have left it odd.
  cluster_.header().phase.store(0, std::memory_order_seq_cst);
}

/// Asks all subscriptions of the cluster to resync. A subscription that is created meanwhile in a
/// slot already passed misses no message: the lost messages had been published before it was
/// matched.
void ReceiveThread::recover() {
  for (uint32_t slot = 0; slot < registry_.endpoints().high_water(); ++slot) {
    if (registry_.endpoints()[slot].cluster == cluster_.id()) {
      const Registry::Lock lock(registry_);  // prevents freeing of subscriptions
      request_resync(slot);
    }
  }
  wake_cluster();
}

void ReceiveThread::request_resync(uint32_t slot) noexcept {
  const EndpointEntry & endpoint = registry_.endpoints()[slot];
  auto * const header = registry_.endpoints().is_live(slot) && endpoint.cluster == cluster_.id() &&
                            endpoint.kind == EndpointKind::subscription
                          ? cluster_.find<SubscriptionHeader>(endpoint.block.offset())
                          : nullptr;
  if (header != nullptr) {
    header->resync.store(1, std::memory_order_seq_cst);
  }
}

/// All writers write whole messages atomically, so a partial message or an unknown kind was written
/// by a foreign program. It may overlap other messages, which are then unreadable too.
bool ReceiveThread::handle(const EmcosMessage & message, const ProcessesChanged & on_change) {
  switch (message.kind) {
    case EmcosMessageKind::publish:
      forward(message);
      return true;
    case EmcosMessageKind::attach:
    case EmcosMessageKind::detach:
      on_change(message.kind, message.process);
      return true;
    case EmcosMessageKind::resync:  // handled by take_overflow()
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
      on_change(EmcosMessageKind::detach, nothing);  // unread messages may include a detach
    }
    if (take_overflow()) {
      wake_cluster();
      on_change(EmcosMessageKind::attach, nothing);  // missing messages may include an attach
    }
  }
}

/// Step 2 of ROS-lite2 Fig. 4: receive thread -> queue -> wake.
void ReceiveThread::forward(const EmcosMessage & message) noexcept {
  const OddPhase phase(cluster_.header().phase);
  if (const Announced announced = Announced::find(registry_, message)) {
    registry_.tracer().note(TraceKind::receive, message.endpoint, message.number, cluster_.id());
    while (!push_to_readers(*announced.source, *announced.dsm, message)) {
    }
    wakes_.flush();
  }
}

/// False if the reader table changed concurrently: an entry may then mix fields of two readers. The
/// retry pushes some hints twice; subscribers ignore duplicates.
bool ReceiveThread::push_to_readers(
  const Cluster & source, TopicDsmHeader & dsm, const EmcosMessage & message) noexcept {
  const uint64_t generation = dsm.match_generation.load(std::memory_order_seq_cst);
  if (const ReaderEntry * const target = target_of(source, dsm, message)) {
    return push_to_reader(*target, dsm, generation, message);
  }
  bool unchanged = true;
  visit_reader_table(source, dsm, [&](const ReaderEntry & entry, uint32_t) {
    unchanged = entry.active.load(std::memory_order_acquire) == 0 ||
                push_to_reader(entry, dsm, generation, message);
    return !unchanged;
  });
  return unchanged;
}

bool ReceiveThread::push_to_reader(
  const ReaderEntry & entry, const TopicDsmHeader & dsm, uint64_t generation,
  const EmcosMessage & message) noexcept {
  // Acquire: a field of the entry's next reader implies that `match_generation` is incremented.
  const uint32_t endpoint = entry.endpoint.load(std::memory_order_acquire);
  if (message.target != nothing && message.target != endpoint) {
    return true;
  }
  const SegmentRef subscription{entry.subscription.load(std::memory_order_acquire)};
  const Hint hint{
    entry.source_index.load(std::memory_order_acquire),
    entry.source_incarnation.load(std::memory_order_acquire), message.number};
  const bool unchanged = dsm.match_generation.load(std::memory_order_seq_cst) == generation;
  if (unchanged && subscription.cluster() == cluster_.id()) {
    push(subscription, hint, message);
  }
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
    WakeWords & wake = registry_.processes()[process].wake;
    const uint32_t endpoint = subscription->endpoint.load(std::memory_order_relaxed);
    wakes_.add(process, wake.mark_arrival(subscription->watchers, endpoint, changes_events));
  }
}

/// Called after each batch: a sender that found the pipe full relies on the receive thread to check
/// the flag after emptying it.
bool ReceiveThread::take_overflow() noexcept {
  std::atomic<uint32_t> & overflow = cluster_.header().pipe_overflow;
  return overflow.load(std::memory_order_seq_cst) != 0 &&
         overflow.exchange(0, std::memory_order_seq_cst) != 0;
}

/// Wakes all processes of the cluster; those without a subscription to resync go back to sleep.
void ReceiveThread::wake_cluster() noexcept {
  for (uint32_t slot = 0; slot < registry_.processes().high_water(); ++slot) {
    if (
      registry_.processes().is_live(slot) && registry_.processes()[slot].cluster == cluster_.id()) {
      registry_.processes()[slot].wake.notify_all();
    }
  }
}

}  // namespace manycore
