// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/topic_dsm/reader_list.hpp"

namespace manycore {

/// A record to announce: where it is, and for whom.
struct Announcement {
  SegmentRef topic_dsm;
  uint32_t endpoint;     ///< publisher's slot
  uint32_t incarnation;  ///< of that slot
  uint64_t number;
  const Gid * target;  ///< only the reader with this gid, or nullptr for all
};

/// Step 1 of Fig. 4, last part: readers of the `own` cluster get a hint on their queue and are
/// woken; every other cluster with a reader gets one eMCOS message. Never waits: where a pipe is
/// full, the readers are told to look for themselves.
void announce(
  Registry & registry, const Cluster & own, const ReaderList & list,
  const Announcement & announcement) noexcept;

}  // namespace manycore
