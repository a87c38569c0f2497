// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/layout/topic_dsm_layout.hpp"

namespace manycore {

/// The newest message of a topic DSM. Record number and sequence number differ because some record
/// numbers are skipped.
struct LastPublished {
  uint64_t number;    ///< record number
  uint64_t sequence;  ///< publication sequence number
  /// False when the two may not belong together: the publisher is stopped between its stores.
  bool exact;
};

/// The publisher stores `skipped_before`, `last`, `skipped_after` in this order. The reader loads
/// them in the opposite order: if the two outer values are equal, `last` was stored with this
/// count. Bounded: never waits for a publisher that is stopped between its stores.
inline LastPublished last_published(const TopicDsmHeader & dsm) noexcept {
  constexpr int tries = 100;
  LastPublished published{};
  for (int i = 0; i < tries && !published.exact; ++i) {
    const uint64_t after = dsm.skipped_after.load(std::memory_order_seq_cst);
    published.number = dsm.last.load(std::memory_order_seq_cst);
    published.sequence = published.number - after;
    published.exact = dsm.skipped_before.load(std::memory_order_seq_cst) == after;
  }
  return published;
}

/// The newest message for the owner of a seat. Of replies, the number may be of a later one than
/// the sequence number is, never of an earlier one.
inline LastPublished last_published_for(const TopicDsmHeader & dsm, const Seat & seat) noexcept {
  if (static_cast<EndpointRole>(dsm.role) != EndpointRole::reply) {
    return last_published(dsm);
  }
  const uint64_t sequence = seat.replies.load(std::memory_order_seq_cst);
  return {seat.last_reply.load(std::memory_order_seq_cst), sequence, true};
}

/// Number of messages that the owner of a seat has not taken, expired ones included.
inline uint64_t owed_to(const TopicDsmHeader & dsm, const Seat & seat) noexcept {
  const LastPublished published = last_published_for(dsm, seat);
  if (seat.taken.load(std::memory_order_seq_cst) >= published.number) {
    return 0;
  }
  const uint64_t accounted = seat.accounted.load(std::memory_order_acquire);
  return published.sequence > accounted ? published.sequence - accounted : 1;
}

}  // namespace manycore
