// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/matching/orphans.hpp"

#include <algorithm>
#include <unordered_map>

#include "transport/layout/subscription_layout.hpp"
#include "transport/peers/endpoint_terms.hpp"
#include "transport/queue/reading.hpp"
#include "transport/registry/endpoint_blocks.hpp"
#include "transport/registry/topic_rows.hpp"
#include "transport/topic_dsm/last_published.hpp"
#include "transport/topic_dsm/seat_table.hpp"
#include "transport/transfer/transfer.hpp"

namespace manycore::orphans {
namespace {

/// Calls `visit(Seat &, EndpointEntry & subscription)` for each seat whose owner is there.
template<typename Visit>
void for_each_owner(
  Registry & registry, const Cluster & cluster, TopicDsmHeader & dsm, Visit visit) {
  visit_seats(cluster, dsm, [&](Seat & seat) {
    if (is_owner_live(registry, seat)) {
      visit(seat, registry.endpoints()[slot_in(seat.owner.load())]);
    }
    return false;
  });
}

SubscriptionHeader * header_of(Registry & registry, const EndpointEntry & subscription) {
  return registry.map<SubscriptionHeader>(subscription.block);
}

Seat * seat_for(Cluster & cluster, TopicDsmHeader & dsm) {
  if (Seat * const free = find_seat(cluster, dsm, 0)) {
    return free;
  }
  const EntryTable<Seat> table = further_seats(cluster, dsm);
  try {
    const uint64_t bytes = table.next_block_bytes();
    return &table.grow(cluster.ref_of(&cluster.allocate_cleared<Seat>(bytes)).offset());
  } catch (const Error &) {
    return nullptr;  // no SMEM
  }
}

/// Asks each reader that is owed something to look: hints of the last records may not have been
/// pushed, or may have been displaced. Only then the phase of a publisher that was killed ends, as
/// a reader takes what it does not know by then for lost. Stores `orphan` last, so all of it is
/// repeated if this process dies.
void tell_readers(Registry & registry, const Cluster & cluster, TopicDsmHeader & dsm) {
  for_each_owner(registry, cluster, dsm, [&](Seat & seat, EndpointEntry & subscription) {
    SubscriptionHeader * const header =
      owed_to(dsm, seat) == 0 ? nullptr : header_of(registry, subscription);
    if (header != nullptr) {
      header->resync.store(1, std::memory_order_seq_cst);
      notify_watchers(registry, *header);
    }
  });
  dsm.phase.store(0, std::memory_order_seq_cst);
  dsm.orphan.store(1, std::memory_order_seq_cst);
}

/// What a subscription keeps, by slot.
using Kept = std::unordered_map<uint32_t, uint64_t>;

/// True if a subscription has room for what it is owed in its history.
bool is_kept(Registry & registry, const Cluster & cluster, TopicDsmHeader & dsm, Kept & kept) {
  bool is_any = false;
  for_each_owner(registry, cluster, dsm, [&](Seat & seat, EndpointEntry & subscription) {
    const uint64_t owed = owed_to(dsm, seat);
    SubscriptionHeader * const header = owed == 0 ? nullptr : header_of(registry, subscription);
    if (
      header == nullptr ||
      !transfer::can_arrive(registry, cluster, dsm, *header, subscription.cluster, seat)) {
      return;
    }
    uint64_t & of_newer = kept[slot_in(seat.owner.load())];
    is_any = is_any || of_newer < header->depth;
    of_newer += header->keep_all != 0 ? 1 : owed;
  });
  return is_any;
}

}  // namespace

void give_seats_to_readers_of_history(
  Registry & registry, Cluster & cluster, EndpointEntry & publisher, TopicDsmHeader & dsm) {
  if (dsm.transient_local == 0 || dsm.last.load() == no_record) {
    return;
  }
  const EndpointTerms terms(publisher);
  for_each_row(
    registry, publisher.topic, EndpointKind::subscription,
    [&](EndpointEntry & entry, uint32_t slot) {
      const uint64_t owner = endpoint_word(slot, entry.slot.incarnation.load());
      if (
        !is_live(entry) || entry.qos.durability != Durability::transient_local ||
        fit_of(terms, entry).kind != Fit::Kind::matched ||
        find_seat(cluster, dsm, owner) != nullptr) {
        return;
      }
      if (Seat * const seat = seat_for(cluster, dsm)) {
        give_seat(*seat, owner, {no_record, last_published(dsm).sequence});
      }
    });
}

void cut(Registry & registry, const char * topic, std::vector<uint32_t> & unwanted) {
  std::vector<uint32_t> closed;
  for_each_row(registry, topic, EndpointKind::publisher, [&](EndpointEntry & entry, uint32_t slot) {
    if (entry.slot.state.load() == SlotState::closed) {
      closed.push_back(slot);
    }
  });
  const uint32_t last = registry.header().last_order;
  std::sort(closed.begin(), closed.end(), [&](uint32_t a, uint32_t b) {
    return last - registry.endpoints()[a].closed_order <
           last - registry.endpoints()[b].closed_order;
  });
  Kept kept;
  for (const uint32_t slot : closed) {
    EndpointEntry & entry = registry.endpoints()[slot];
    const Cluster * const cluster = registry.map_cluster(entry.block.cluster());
    auto * const dsm = registry.map<TopicDsmHeader>(entry.block);
    if (cluster == nullptr || dsm == nullptr) {
      continue;
    }
    if (dsm->orphan.load() == 0) {
      tell_readers(registry, *cluster, *dsm);
    }
    if (!is_kept(registry, *cluster, *dsm, kept)) {
      entry.slot.state.store(SlotState::freeing, std::memory_order_seq_cst);
      unwanted.push_back(slot);
    }
  }
}

bool is_being_read(Registry & registry, const EndpointEntry & publisher, uint32_t slot) {
  const Reading reading(slot, publisher.slot.incarnation.load());
  bool is_any = false;
  for_each_row(
    registry, publisher.topic, EndpointKind::subscription, [&](EndpointEntry & entry, uint32_t) {
      const SubscriptionHeader * const header =
        is_live(entry) ? header_of(registry, entry) : nullptr;
      is_any = is_any || (header != nullptr &&
                          reading.is_any(header->reading.load(std::memory_order_seq_cst)));
    });
  return is_any;
}

void count_undelivered(Registry & registry, const Cluster & cluster, TopicDsmHeader & dsm) {
  for_each_owner(registry, cluster, dsm, [&](Seat & seat, EndpointEntry & subscription) {
    const LastPublished published = last_published_for(dsm, seat);
    const uint64_t accounted = seat.accounted.load(std::memory_order_acquire);
    if (published.exact && published.sequence > accounted) {
      subscription.counters.lost.fetch_add(
        published.sequence - accounted, std::memory_order_relaxed);
      seat.accounted.store(published.sequence, std::memory_order_release);
      notify_event_watchers(registry, subscription.process);
    }
  });
}

}  // namespace manycore::orphans
