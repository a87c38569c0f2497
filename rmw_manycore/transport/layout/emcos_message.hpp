// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <climits>
#include <cstdint>
#include <type_traits>

#include "transport/layout/segment_layout.hpp"

namespace manycore {

/// Kinds of eMCOS messages; the values detect foreign bytes in a pipe.
enum class EmcosMessageKind : uint32_t {
  publish = 0x4d43'0001,  ///< a record was published for subscriptions of the receiving cluster
  attach = 0x4d43'0002,   ///< a process joined the cluster: start watching it
  detach = 0x4d43'0003,   ///< a process left the cluster: check whether it was the last one
  /// Hints may be missing in this cluster: wake subscriptions that must resync.
  resync = 0x4d43'0004,
};

/// Message sent through a cluster's pipe. It carries timing, never data (ROS-lite2 III-B). At most
/// PIPE_BUF bytes, so writes are atomic.
struct EmcosMessage {
  EmcosMessageKind kind;
  uint32_t process;      ///< attach: slot of the process, or `nothing` to check all
  SegmentRef topic_dsm;  ///< publish: its header
  uint32_t endpoint;     ///< publish: slot of the publisher
  uint32_t incarnation;  ///< publish: incarnation of that slot
  uint64_t number;       ///< publish: number of the record
  uint32_t target;       ///< publish: slot of the only subscription to notify, or `nothing` for all
  uint32_t target_incarnation;  ///< publish with a target: incarnation of that slot
  uint64_t padding[3];
};
static_assert(sizeof(EmcosMessage) == 64 && sizeof(EmcosMessage) <= PIPE_BUF);
static_assert(std::is_trivially_copyable_v<EmcosMessage>);

}  // namespace manycore
