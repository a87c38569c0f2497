// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "transport/layout/topic_dsm_layout.hpp"
#include "transport/notification/pending_wakes.hpp"
#include "transport/queue/subscriber_queue.hpp"
#include "transport/registry/registry.hpp"

namespace manycore {

/// The receive thread of one cluster (ROS-lite2 III-B): takes publish notices off the cluster's
/// pipe, pushes them on the queues of the cluster's subscriptions and wakes their nodes. The
/// owner's thread runs it.
class ReceiveThread {
public:
  using ProcessesChanged = std::function<void(EmcosMessageKind)>;

  ReceiveThread(Registry & registry, uint32_t cluster);

  /// After the death of a predecessor, or of messages: every subscription of the cluster looks for
  /// itself once.
  void recover();

  /// For ever. `on_change` is told of attach and detach messages.
  void run(const ProcessesChanged & on_change);

private:
  static constexpr size_t batch_size = 64;

  /// False for a message of no known kind.
  bool handle(const EmcosMessage & message, const ProcessesChanged & on_change);
  void forward(const EmcosMessage & message) noexcept;
  /// Its publisher still has its topic DSM.
  bool is_there(const EmcosMessage & message) const noexcept;
  bool push_to_readers(
    const Cluster & source, TopicDsmHeader & dsm, const EmcosMessage & message) noexcept;
  void push(SegmentRef subscription, const Hint & hint, const EmcosMessage & message) noexcept;
  bool take_overflow() noexcept;
  void wake_who_must_look() noexcept;

  Registry & registry_;
  Cluster & cluster_;
  PendingWakes wakes_;
  EmcosMessage batch_[batch_size];
};

}  // namespace manycore
