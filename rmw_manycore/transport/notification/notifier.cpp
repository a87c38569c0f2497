// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/notification/notifier.hpp"

#include <utility>

#include "transport/queue/subscriber_queue.hpp"

namespace manycore {
namespace {

/// Pushes to the readers of the own cluster; returns the bit mask of the other clusters with
/// readers.
uint64_t push_to_own_cluster(
  Tracer & tracer, const Cluster & own, const Readers & readers,
  const Announcement & announcement) noexcept {
  uint64_t others = 0;
  WakeWords * pending = nullptr;  // readers are grouped by process
  WakeSet words;
  const Hint hint{announcement.endpoint, announcement.incarnation, announcement.number};
  for (const Reader & reader : readers) {
    if (reader.seat == nullptr) {
      continue;
    }
    if (reader.cluster != own.id()) {
      others |= uint64_t{1} << (reader.cluster - 1);
      continue;
    }
    tracer.note(
      TraceKind::hint, reader.endpoint, announcement.number,
      trace_endpoint(announcement.endpoint, announcement.incarnation));
    const bool changes_events = subscriber_queue::push(*reader.subscription, hint);
    if (pending != reader.wake && pending != nullptr) {
      tracer.note(TraceKind::wake, announcement.endpoint, announcement.number, words.count());
      pending->notify(std::exchange(words, {}));
    }
    pending = reader.wake;
    words |= pending->mark_arrival(
      reader.subscription->watchers, reader.endpoint, changes_events,
      pending == announcement.publishing ? announcement.spared : WakeSet{});
  }
  if (pending != nullptr) {
    tracer.note(TraceKind::wake, announcement.endpoint, announcement.number, words.count());
    pending->notify(words);
  }
  return others;
}

/// Called where the readers in that cluster have to look for themselves.
void request_resync(const Cluster & cluster, const Readers & readers) noexcept {
  for (const Reader & reader : readers) {
    if (reader.cluster == cluster.id()) {
      reader.subscription->resync.store(1, std::memory_order_seq_cst);
    }
  }
  cluster.wake_resyncing();
}

}  // namespace

void announce(
  Registry & registry, const Cluster & own, const ReaderList & list,
  const Announcement & announcement, TransferSender & sender) noexcept {
  const bool is_targeted = announcement.target != nullptr;
  const Readers readers = is_targeted ? list.with_gid(*announcement.target) : list.all();
  uint64_t others = push_to_own_cluster(registry.tracer(), own, readers, announcement);
  if (others == 0) {
    return;
  }
  EmcosMessage message{};
  message.kind = EmcosMessageKind::publish;
  message.topic_dsm = announcement.topic_dsm;
  message.endpoint = announcement.endpoint;
  message.incarnation = announcement.incarnation;
  message.number = announcement.number;
  message.target = is_targeted ? readers.begin()->endpoint : nothing;
  message.target_incarnation = is_targeted ? readers.begin()->incarnation : 0;
  for (; others != 0; others &= others - 1) {
    const uint32_t id = static_cast<uint32_t>(__builtin_ctzll(others)) + 1;
    Cluster * const cluster = registry.clusters().find(id);
    registry.tracer().note(TraceKind::send, announcement.endpoint, announcement.number, id);
    if (cluster != nullptr && !sender.hand_over(message, *cluster)) {
      request_resync(*cluster, readers);
    }
  }
}

}  // namespace manycore
