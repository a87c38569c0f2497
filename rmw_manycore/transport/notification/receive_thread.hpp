// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <unordered_map>

#include "transport/notification/pending_wakes.hpp"
#include "transport/peers/peers.hpp"
#include "transport/queue/subscriber_queue.hpp"
#include "transport/registry/registry.hpp"

namespace manycore {

/// The receive thread of one cluster (ROS-lite2 III-B): reads eMCOS messages from the cluster's
/// pipe, pushes hints to the queues of its subscriptions and wakes their processes. Runs in the
/// thread that calls run().
class ReceiveThread {
public:
  /// `process`: slot of the process that joined, or `nothing` if any may have joined or left.
  using ProcessesChanged = std::function<void(EmcosMessageKind kind, uint32_t process)>;

  ReceiveThread(Registry & registry, uint32_t cluster);

  /// Sets each subscription of the cluster to resync. Called after a predecessor died, or after
  /// messages were lost.
  void recover();

  /// Never returns. Calls `on_change` for each attach and detach message.
  void run(const ProcessesChanged & on_change);

private:
  static constexpr size_t batch_size = 64;
  static constexpr size_t min_publishers = 64;

  /// False for an unknown message kind.
  bool handle(const EmcosMessage & message, const ProcessesChanged & on_change);
  void forward(const EmcosMessage & message) noexcept;
  /// May throw std::bad_alloc.
  const Peers * readers_of(const EmcosMessage & message);
  void push_to_target(const EmcosMessage & message) noexcept;
  void push(
    uint32_t slot, uint32_t process, SegmentRef block, const EmcosMessage & message) noexcept;
  void request_resync(uint32_t slot) noexcept;
  bool take_overflow() noexcept;
  void wake_cluster() noexcept;

  Registry & registry_;
  Cluster & cluster_;
  PendingWakes wakes_;
  EmcosMessage batch_[batch_size];
  /// A publisher from which a message has come.
  struct Publisher {
    uint32_t incarnation = 0;
    std::optional<Peers> readers;
  };
  /// May throw std::bad_alloc.
  Publisher & publisher_in(uint32_t slot);

  std::unordered_map<uint32_t, Publisher> publishers_;  ///< by slot
  size_t max_publishers_ = min_publishers;  ///< known ones at which those that left are forgotten
  bool must_recover_ = false;
};

}  // namespace manycore
