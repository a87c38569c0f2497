// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/notification/notifier.hpp"

#include <utility>

#include "transport/queue/source_table.hpp"
#include "transport/queue/subscriber_queue.hpp"

namespace manycore {
namespace {

bool is_for(const Announcement & announcement, const Reader & reader) noexcept {
  return announcement.target == nullptr || *announcement.target == reader.gid;
}

/// A displaced hint is most often one of the same publisher, whose source is known.
void note_displaced(const Cluster & own, const Reader & reader, const Hint & oldest) noexcept {
  if (oldest.source == reader.source_index) {
    note_displaced(*reader.source, oldest);
  } else {
    note_displaced(own, *reader.subscription, oldest);
  }
}

/// Pushes to the own cluster's readers; returns the mask of the other clusters concerned.
uint64_t push_to_own_cluster(
  Tracer & tracer, const Cluster & own, const ReaderList & list,
  const Announcement & announcement) noexcept {
  uint64_t others = 0;
  WakeWords * pending = nullptr;  // readers of one process stand together
  WakeSet words;
  for (const Reader & reader : list.readers()) {
    if (!is_for(announcement, reader)) {
      continue;
    }
    if (reader.cluster != own.id()) {
      others |= uint64_t{1} << (reader.cluster - 1);
      continue;
    }
    tracer.note(
      TraceKind::hint, reader.endpoint, announcement.number,
      trace_endpoint(announcement.endpoint, announcement.incarnation));
    const bool changes_events = subscriber_queue::push(
      *reader.subscription, {reader.source_index, reader.source_incarnation, announcement.number},
      [&](const Hint & oldest) { note_displaced(own, reader, oldest); });
    if (pending != reader.wake && pending != nullptr) {
      tracer.note(TraceKind::wake, announcement.endpoint, announcement.number, words.count());
      pending->notify(std::exchange(words, {}));
    }
    pending = reader.wake;
    words |= pending->set_of(reader.subscription->watchers, changes_events);
  }
  if (pending != nullptr) {
    tracer.note(TraceKind::wake, announcement.endpoint, announcement.number, words.count());
    pending->notify(words);
  }
  return others;
}

/// The target's slot for the receive thread, which knows no gids.
uint32_t target_slot(const ReaderList & list, const Announcement & announcement) noexcept {
  if (announcement.target == nullptr) {
    return nothing;
  }
  for (const Reader & reader : list.readers()) {
    if (is_for(announcement, reader)) {
      return reader.endpoint;
    }
  }
  return nothing;
}

/// The pipe was full. Either it still is after `pipe_overflow` is set, then the receive thread has
/// yet to read from it and looks at the flag afterwards; or the message gets in.
void ask_to_look(Cluster & cluster, const ReaderList & list) noexcept {
  for (const Reader & reader : list.readers()) {
    if (reader.cluster == cluster.id()) {
      reader.subscription->resync.store(1, std::memory_order_seq_cst);
    }
  }
  cluster.header().pipe_overflow.store(1, std::memory_order_seq_cst);
  EmcosMessage message{};
  message.kind = EmcosMessageKind::resync;
  cluster.send(message);
}

}  // namespace

void announce(
  Registry & registry, const Cluster & own, const ReaderList & list,
  const Announcement & announcement) noexcept {
  uint64_t others = push_to_own_cluster(registry.tracer(), own, list, announcement);
  if (others == 0) {
    return;
  }
  EmcosMessage message{};
  message.kind = EmcosMessageKind::publish;
  message.topic_dsm = announcement.topic_dsm;
  message.endpoint = announcement.endpoint;
  message.incarnation = announcement.incarnation;
  message.number = announcement.number;
  message.target = target_slot(list, announcement);
  for (; others != 0; others &= others - 1) {
    const uint32_t id = static_cast<uint32_t>(__builtin_ctzll(others)) + 1;
    Cluster * const cluster = registry.clusters().find(id);
    registry.tracer().note(TraceKind::send, announcement.endpoint, announcement.number, id);
    if (cluster != nullptr && !cluster->send(message)) {
      ask_to_look(*cluster, list);
    }
  }
}

}  // namespace manycore
