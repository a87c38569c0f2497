// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>

#include "transport/layout/deadline_clock.hpp"
#include "transport/peers/matches.hpp"
#include "transport/publisher/publisher.hpp"
#include "transport/qos/manual_liveliness.hpp"
#include "transport/registry/membership.hpp"
#include "transport/topic_dsm/topic_dsm_writer.hpp"
#include "transport/transfer/transfer.hpp"

namespace manycore {

/// State of a publisher in its process; shared state is in the endpoint entry and the topic DSM.
struct Publisher::Impl {
  Impl(Registry & registry_, uint32_t slot_)
  : registry(registry_),
    slot(slot_),
    entry(registry_.endpoints()[slot_]),
    membership(registry_, entry.slot),
    cluster(registry_.clusters().at(entry.cluster)),
    writer(registry_, cluster, entry),
    liveliness(entry.asserted_ns, entry.qos.liveliness_lease_ns),
    sender(registry_, cluster, entry),
    matches(registry_, entry) {
    deadline.reset();
  }

  bool has_deadline() const noexcept { return entry.qos.deadline_ns != infinite_ns; }
  bool is_manual() const noexcept {
    return entry.qos.liveliness == Liveliness::manual_by_topic &&
           entry.qos.liveliness_lease_ns != infinite_ns;
  }
  /// Exclusive access to the topic DSM; blocks while another thread has it.
  Writing write() { return Writing(mutex, writer, membership); }
  /// A message in the room of the writer.
  struct Written {
    size_t size_bytes;
    int64_t source_timestamp_ns;
    Correlation correlation;
  };
  /// Publishes it. The caller has a Writing.
  uint64_t publish(const Written & written, const WakeSet & spared);
  void trace_write(size_t size_bytes, const Correlation & correlation) noexcept;
  /// Wakes threads that wait for events of matched subscriptions.
  void notify_event_watchers();
  void notify_readers_of_event() noexcept;  ///< the same, while a Writing exists

  Registry & registry;
  uint32_t slot;
  EndpointEntry & entry;
  Membership membership;
  Cluster & cluster;
  std::mutex mutex;  ///< guards `writer`; held by Writing
  TopicDsmWriter writer;
  uint64_t published = 0;
  DeadlineClock deadline;
  ManualLiveliness liveliness;
  TransferSender sender;
  Matches matches;
};

}  // namespace manycore
