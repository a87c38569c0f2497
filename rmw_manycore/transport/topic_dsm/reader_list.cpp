// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/topic_dsm/reader_list.hpp"

#include <algorithm>
#include <new>
#include <numeric>

#include "transport/registry/block_in_hand.hpp"
#include "transport/registry/endpoint_blocks.hpp"
#include "transport/registry/snapshot.hpp"
#include "transport/transfer/transfer.hpp"

namespace manycore {
namespace {

constexpr size_t nowhere = SIZE_MAX;  ///< a reader that is not in the list

}  // namespace

ReaderList::ReaderList(
  Registry & registry, Cluster & cluster, TopicDsmHeader & dsm, EndpointEntry & own)
: registry_(registry),
  cluster_(cluster),
  dsm_(dsm),
  peers_(registry, own),
  reading_(dsm.endpoint.load(), dsm.incarnation.load()) {}

void ReaderList::begin_phase(const SeatStart & start) noexcept {
  if (!try_to_refresh(start)) {
    readers_.clear();
    by_gid_.clear();
  }
}

void ReaderList::refresh(const SeatStart & start) noexcept { try_to_refresh(start); }

bool ReaderList::try_to_refresh(const SeatStart & start) noexcept {
  try {
    if (peers_.refresh() || obstacle_) {
      rebuild(start);
    }
    return true;
  } catch (const std::bad_alloc &) {
    peers_.forget_changes();
    is_any_hidden_ = true;
    obstacle_ = std::current_exception();
    return false;
  }
}

void ReaderList::serve_without_list(const SeatStart & start) noexcept {
  registry_.for_each_of_bucket(
    peers_.own().topic.c_str(), [&](uint32_t slot) { serve(slot, start); });
}

void ReaderList::serve(uint32_t slot, const SeatStart & start) noexcept {
  const EntryCopy<EndpointEntry> row(registry_.endpoints(), slot);
  if (!row.holds() || fit_of(peers_.own(), *row).kind != Fit::Kind::matched) {
    return;
  }
  auto * const header = registry_.clusters().find<SubscriptionHeader>((*row).block);
  const uint64_t word = endpoint_word(slot, row.incarnation());
  if (header == nullptr || header->magic.load() != subscription_magic) {
    return;
  }
  if (find_seat(cluster_, dsm_, word) == nullptr) {
    if (Seat * const free = find_seat(cluster_, dsm_, 0)) {
      give_seat(*free, word, start);
    }
  }
  header->resync.store(1, std::memory_order_seq_cst);
  notify_watchers(registry_, *header);
}

void ReaderList::rebuild(const SeatStart & start) {
  next_.clear();
  by_word_.clear();
  std::exception_ptr obstacle;
  for (const Peer & peer : peers_.all()) {
    by_word_.emplace_back(endpoint_word(peer.slot, peer.incarnation), nowhere);
    try {
      const Reader reader = resolve(peer);
      if (can_reach(reader)) {
        by_word_.back().second = next_.size();
        next_.push_back(reader);
      }
    } catch (const Error &) {
      obstacle = std::current_exception();
    }
  }
  is_any_hidden_ = obstacle != nullptr;
  obstacle_ = obstacle;
  look_at_seats();
  give_seats(start);
  sort();
  readers_.swap(next_);
}

/// Finds the seats that were given, and takes those of readers back that have left.
void ReaderList::look_at_seats() {
  std::sort(by_word_.begin(), by_word_.end());
  free_seats_.clear();
  visit_seats(cluster_, dsm_, [this](Seat & seat) {
    const uint64_t owner = seat.owner.load(std::memory_order_relaxed);
    const auto found = std::lower_bound(
      by_word_.begin(), by_word_.end(), owner,
      [](const auto & entry, uint64_t wanted) { return entry.first < wanted; });
    const bool is_taken = owner != 0 && found != by_word_.end() && found->first == owner;
    if (is_taken && found->second != nowhere) {
      next_[found->second].seat = &seat;
    }
    if (!is_taken) {
      seat.owner.store(0, std::memory_order_release);
      free_seats_.push_back(&seat);
    }
    return false;
  });
  std::reverse(free_seats_.begin(), free_seats_.end());
}

Reader ReaderList::resolve(const Peer & peer) {
  Reader reader;
  reader.endpoint = peer.slot;
  reader.incarnation = peer.incarnation;
  reader.cluster = peer.block.cluster();
  reader.subscription =
    registry_.clusters().at(reader.cluster).find<SubscriptionHeader>(peer.block.offset());
  if (reader.subscription == nullptr || peer.process >= registry_.processes().high_water()) {
    throw Error(
      ErrorCode::corrupt,
      "the registry is damaged; stop the platform's nodes and run 'manycore "
      "clean'");
  }
  reader.wake = &registry_.processes()[peer.process].wake;
  reader.reliable = peer.reliability == Reliability::reliable;
  reader.reads_history = dsm_.transient_local != 0 &&
                         static_cast<EndpointRole>(dsm_.role) != EndpointRole::reply &&
                         peer.durability == Durability::transient_local;
  reader.gid = peer.gid;
  return reader;
}

/// Attaching such a place raises `changes`.
bool ReaderList::can_reach(const Reader & reader) const noexcept {
  if (dsm_.transfer == static_cast<uint8_t>(Transfer::dsm) || reader.cluster == cluster_.id()) {
    return true;
  }
  const Cluster * const receiver = registry_.clusters().find(reader.cluster);
  return receiver != nullptr && transfer::has_room(cluster_, dsm_, *receiver);
}

/// A reader without a seat is not pushed to: it would not find where it starts. One of the history
/// is owed all that is left of it, of which no process counts losses.
void ReaderList::give_seats(const SeatStart & start) {
  for (Reader & reader : next_) {
    try {
      if (reader.seat == nullptr) {
        reader.seat = &free_seat();
        give_seat(
          *reader.seat, reader.word(),
          {reader.reads_history ? no_record : start.taken, start.accounted});
      }
    } catch (const Error &) {
      obstacle_ = std::current_exception();
      return;
    }
  }
}

Seat & ReaderList::free_seat() {
  if (free_seats_.empty()) {
    grow_seats();
  }
  Seat & free = *free_seats_.back();
  free_seats_.pop_back();
  return free;
}

/// The block is cleared before it is attached, so all of its seats are free.
void ReaderList::grow_seats() {
  const EntryTable<Seat> table = further_seats(cluster_, dsm_);
  const uint64_t bytes = table.next_block_bytes();
  if (bytes <= BlockInHand::max_bytes_at_once) {
    cluster_.back_ahead();
    const Registry::Lock lock(registry_, Registry::Lock::WhileOwnersRun{});
    note_free(table.grow(cluster_.ref_of(&cluster_.allocate_cleared<Seat>(bytes)).offset()), bytes);
    return;
  }
  BlockInHand hand(registry_, Registry::Lock::short_wait_ns);
  const Membership membership(registry_, registry_.endpoints()[dsm_.endpoint.load()].slot);
  hand.make(membership, {cluster_.id(), bytes, bytes, false});
  const Registry::Lock lock(registry_, Registry::Lock::WhileOwnersRun{});
  Seat & first = table.grow(hand.block().offset());
  hand.let_go();
  note_free(first, bytes);
}

void ReaderList::note_free(Seat & first, uint64_t bytes) {
  for (uint64_t i = bytes / sizeof(Seat); i-- != 0;) {
    free_seats_.push_back(&first + i);
  }
}

void ReaderList::sort() {
  // Group readers by process, so that each process is woken once.
  std::sort(
    next_.begin(), next_.end(), [](const Reader & a, const Reader & b) { return a.wake < b.wake; });
  by_gid_.resize(next_.size());
  std::iota(by_gid_.begin(), by_gid_.end(), 0);
  std::sort(by_gid_.begin(), by_gid_.end(), [this](uint32_t a, uint32_t b) {
    return next_[a].gid < next_[b].gid;
  });
}

void ReaderList::throw_obstacle(const std::string & topic) const {
  try {
    std::rethrow_exception(obstacle_);
  } catch (const Error & error) {
    throw Error(
      error.code(),
      "cannot publish on '" + topic + "': cannot reach a subscription: " + error.what());
  }
}

Readers ReaderList::with_gid(const Gid & gid) const noexcept {
  const auto found = std::lower_bound(
    by_gid_.begin(), by_gid_.end(), gid,
    [this](uint32_t index, const Gid & wanted) { return readers_[index].gid < wanted; });
  const bool is_there = found != by_gid_.end() && readers_[*found].gid == gid;
  return is_there ? Readers(&readers_[*found], 1) : Readers(nullptr, 0);
}

}  // namespace manycore
