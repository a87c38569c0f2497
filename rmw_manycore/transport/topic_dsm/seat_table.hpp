// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/layout/topic_dsm_layout.hpp"
#include "transport/registry/entry_table.hpp"
#include "transport/registry/registry.hpp"

namespace manycore {

/// Seats beyond those in the header.
inline EntryTable<Seat> further_seats(const Cluster & cluster, TopicDsmHeader & dsm) noexcept {
  return {cluster, dsm.further_seats};
}

/// Calls `visit(Seat &)` for each seat, used or free, until it returns true.
template<typename Visit>
void visit_seats(const Cluster & cluster, TopicDsmHeader & dsm, Visit visit) {
  for (Seat & seat : dsm.seats) {
    if (visit(seat)) {
      return;
    }
  }
  further_seats(cluster, dsm).visit(visit);
}

/// The seat of a subscription, or with `owner` = 0 a free one; nullptr if there is none.
inline Seat * find_seat(const Cluster & cluster, TopicDsmHeader & dsm, uint64_t owner) {
  Seat * found = nullptr;
  visit_seats(cluster, dsm, [&](Seat & seat) {
    found = seat.owner.load(std::memory_order_acquire) == owner ? &seat : nullptr;
    return found != nullptr;
  });
  return found;
}

/// The values with which a seat begins.
struct SeatStart {
  uint64_t taken;      ///< record number
  uint64_t accounted;  ///< publication sequence number
};

/// Stores `owner` last: a subscription that finds its seat finds where it starts.
inline void give_seat(Seat & seat, uint64_t owner, const SeatStart & start) noexcept {
  seat.taken.store(start.taken, std::memory_order_relaxed);
  seat.accounted.store(start.accounted, std::memory_order_relaxed);
  seat.last_reply.store(no_record, std::memory_order_relaxed);
  seat.replies.store(0, std::memory_order_relaxed);
  seat.owner.store(owner, std::memory_order_release);
}

/// True if the subscription that owns the seat is there.
inline bool is_owner_live(Registry & registry, const Seat & seat) noexcept {
  const uint64_t owner = seat.owner.load(std::memory_order_acquire);
  return owner != 0 && registry.endpoints().is_live(slot_in(owner)) &&
         registry.endpoints()[slot_in(owner)].slot.incarnation.load() == incarnation_in(owner);
}

}  // namespace manycore
