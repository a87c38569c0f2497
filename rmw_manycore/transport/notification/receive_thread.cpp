// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/notification/receive_thread.hpp"

#include <algorithm>
#include <iterator>
#include <new>
#include <utility>

#include "transport/registry/odd_phase.hpp"
#include "transport/registry/snapshot.hpp"

namespace manycore {
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
    for (size_t i = 0; i < count && understood && !must_recover_; ++i) {
      understood = handle(batch_[i], on_change);
    }
    header.messages.store(
      header.messages.load(std::memory_order_relaxed) + count, std::memory_order_relaxed);
    if (!understood || std::exchange(must_recover_, false)) {
      recover();
      on_change(EmcosMessageKind::detach, nothing);  // unread messages may include a detach
    }
    if (take_overflow()) {
      wake_cluster();
      on_change(EmcosMessageKind::attach, nothing);  // missing messages may include an attach
    }
  }
}

/// Step 2 of ROS-lite2 Fig. 4: receive thread -> queue -> wake. Reads rows only, never the topic
/// DSM, which may be freed: the hint is then one more stale one.
void ReceiveThread::forward(const EmcosMessage & message) noexcept {
  const OddPhase phase(cluster_.header().phase);
  registry_.tracer().note(TraceKind::receive, message.endpoint, message.number, cluster_.id());
  try {
    if (message.target != nothing) {
      push_to_target(message);
    } else if (const Peers * const readers = readers_of(message)) {
      for (const Peer & reader : readers->all()) {
        push(reader.slot, reader.process, reader.block, message);
      }
    }
  } catch (const std::bad_alloc &) {
    must_recover_ = true;  // hints are missing
  }
  wakes_.flush();
}

/// The client that a reply names, if its row is live in this phase.
void ReceiveThread::push_to_target(const EmcosMessage & message) noexcept {
  if (message.target >= registry_.endpoints().high_water()) {
    return;
  }
  const EntryCopy<EndpointEntry> row(registry_.endpoints(), message.target);
  if (
    (*row).kind == EndpointKind::subscription && row.incarnation() == message.target_incarnation &&
    row.holds()) {
    push(message.target, (*row).process.load(), (*row).block, message);
  }
}

/// The readers of a message's publisher, renewed in this phase, after the message was read: so one
/// that was there when the record was published is among them. Nullptr if the publisher is gone.
const Peers * ReceiveThread::readers_of(const EmcosMessage & message) {
  if (message.endpoint >= registry_.endpoints().high_water()) {
    return nullptr;
  }
  Publisher & known = publisher_in(message.endpoint);
  if (!known.readers || known.incarnation != message.incarnation) {
    const EntryCopy<EndpointEntry> row(registry_.endpoints(), message.endpoint);
    if (
      row.incarnation() != message.incarnation || !row.is_whole() ||
      (*row).kind != EndpointKind::publisher) {
      return nullptr;
    }
    known.readers.emplace(registry_, *row);
    known.incarnation = message.incarnation;
  }
  known.readers->refresh();
  return &*known.readers;
}

/// Publishers that left are forgotten whenever the number of known ones has doubled, so memory
/// follows the number that is there, at a constant cost for each new one.
ReceiveThread::Publisher & ReceiveThread::publisher_in(uint32_t slot) {
  if (publishers_.size() >= max_publishers_) {
    for (auto known = publishers_.begin(); known != publishers_.end();) {
      const Slot & row = registry_.endpoints()[known->first].slot;
      const bool is_there = has_memory(row.state.load(std::memory_order_acquire)) &&
                            row.incarnation.load() == known->second.incarnation;
      known = is_there ? std::next(known) : publishers_.erase(known);
    }
    max_publishers_ = std::max(2 * publishers_.size(), min_publishers);
  }
  return publishers_[slot];
}

void ReceiveThread::push(
  uint32_t slot, uint32_t process, SegmentRef block, const EmcosMessage & message) noexcept {
  auto * const subscription =
    block.cluster() == cluster_.id() ? cluster_.find<SubscriptionHeader>(block.offset()) : nullptr;
  if (
    subscription == nullptr ||
    subscription->magic.load(std::memory_order_relaxed) != subscription_magic) {
    return;
  }
  registry_.tracer().note(
    TraceKind::hint, slot, message.number, trace_endpoint(message.endpoint, message.incarnation));
  const bool changes_events =
    subscriber_queue::push(*subscription, {message.endpoint, message.incarnation, message.number});
  ClusterHeader & header = cluster_.header();
  header.notifications.store(
    header.notifications.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  if (process < registry_.processes().high_water()) {
    WakeWords & wake = registry_.processes()[process].wake;
    wakes_.add(process, wake.mark_arrival(subscription->watchers, slot, changes_events));
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
