// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/layout/topic_dsm_layout.hpp"

namespace manycore {

/// Wakes a RELIABLE + KEEP_ALL publisher that waits for one of its readers. Called after `taken` of
/// the reader's seat was stored, or its row was closed. Makes no system call unless the publisher
/// waits.
///
/// No wake-up is lost: the publisher stores `writer_waits` before it loads `taken` and the row, the
/// caller stores one of these before it loads `writer_waits`. All accesses are seq_cst, so at least
/// one of them sees the other (docs/model/progress.pml).
inline void notify_waiting_publisher(TopicDsmHeader & dsm) noexcept {
  if (dsm.writer_waits.load(std::memory_order_seq_cst) != 0) {
    dsm.progress.fetch_add(1, std::memory_order_seq_cst);
    futex_wake_all(dsm.progress);
  }
}

}  // namespace manycore
