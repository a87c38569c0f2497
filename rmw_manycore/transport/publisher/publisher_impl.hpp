// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>

#include "transport/layout/deadline_clock.hpp"
#include "transport/publisher/publisher.hpp"
#include "transport/qos/manual_liveliness.hpp"
#include "transport/registry/membership.hpp"
#include "transport/topic_dsm/topic_dsm_writer.hpp"

namespace manycore {

struct Publisher::Impl {
  Impl(Registry & registry_, uint32_t slot_)
  : registry(registry_),
    slot(slot_),
    entry(registry_.endpoints()[slot_]),
    membership(registry_, entry.slot),
    cluster(registry_.clusters().at(entry.cluster)),
    writer(registry_, cluster, entry),
    liveliness(entry.asserted_ns, entry.qos.liveliness_lease_ns) {
    deadline.reset();
  }

  bool has_deadline() const noexcept { return entry.qos.deadline_ns != infinite_ns; }
  bool is_manual() const noexcept {
    return entry.qos.liveliness == Liveliness::manual_by_topic &&
           entry.qos.liveliness_lease_ns != infinite_ns;
  }
  /// This thread's turn; waits for that of another one.
  Writing write() { return Writing(mutex, writer, membership); }
  void trace_write(size_t size_bytes, const Correlation & correlation) noexcept;
  /// Wakes the processes of the readers that wait for events.
  void tell_event_watchers();

  Registry & registry;
  uint32_t slot;
  EndpointEntry & entry;
  Membership membership;
  Cluster & cluster;
  std::mutex mutex;  ///< of Writing
  TopicDsmWriter writer;
  uint64_t published = 0;
  DeadlineClock deadline;
  ManualLiveliness liveliness;
};

}  // namespace manycore
