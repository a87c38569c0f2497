// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <climits>
#include <cstdint>
#include <type_traits>

#include "transport/layout/segment_layout.hpp"

namespace manycore {

enum class EmcosMessageKind : uint32_t {
  publish = 0x4d43'0001,  ///< a record was published for subscriptions of the receiving cluster
  attach = 0x4d43'0002,   ///< a process joined the cluster: watch it
  detach = 0x4d43'0003,   ///< a process left: see whether it was the last
  resync = 0x4d43'0004,   ///< hints may be missing in this cluster: wake who must scan
};

/// What travels through the clusters' pipes: timing only, never data (ROS-lite2 III-B).
struct EmcosMessage {
  EmcosMessageKind kind;
  uint32_t process;      ///< attach, detach: process slot
  SegmentRef topic_dsm;  ///< publish
  uint32_t endpoint;     ///< publish: publisher's slot
  uint32_t incarnation;  ///< publish: of that slot
  uint64_t number;       ///< publish: record number
  uint32_t target;       ///< publish: only this subscription's slot, or `nothing` for all
  uint32_t reserved;
  uint64_t padding[3];
};
static_assert(sizeof(EmcosMessage) == 64 && sizeof(EmcosMessage) <= PIPE_BUF);
static_assert(std::is_trivially_copyable_v<EmcosMessage>);

}  // namespace manycore
