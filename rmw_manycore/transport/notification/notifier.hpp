// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/topic_dsm/reader_list.hpp"
#include "transport/transfer/transfer.hpp"

namespace manycore {

/// A published record and the readers to notify.
struct Announcement {
  SegmentRef topic_dsm;
  uint32_t endpoint;     ///< slot of the publisher
  uint32_t incarnation;  ///< of that slot
  uint64_t number;
  const Gid * target;            ///< gid of the only reader to notify, or nullptr for all
  const WakeWords * publishing;  ///< words of the publisher's process
  WakeSet spared;                ///< words of that process that need not be woken for the arrival
};

/// Step 1 of ROS-lite2 Fig. 4, last part: pushes a hint to each reader of the `own` cluster and
/// wakes its process; sends one eMCOS message to each other cluster with a reader. Never blocks: if
/// a pipe is full, the readers behind it are set to resync. Only a `sender` of synchronous records
/// blocks, at most for its timeout.
void announce(
  Registry & registry, const Cluster & own, const ReaderList & list,
  const Announcement & announcement, TransferSender & sender) noexcept;

}  // namespace manycore
