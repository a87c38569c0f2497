// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>
#include <string>
#include <utility>
#include <vector>

#include "platform/error.hpp"
#include "transport/layout/subscription_layout.hpp"
#include "transport/layout/topic_dsm_layout.hpp"
#include "transport/peers/peers.hpp"
#include "transport/queue/reading.hpp"
#include "transport/topic_dsm/seat_table.hpp"

namespace manycore {

/// One reader of the publisher's own topic DSM, resolved to addresses in this process.
struct Reader {
  Seat * seat = nullptr;  ///< nullptr while there is no SMEM for one: nothing is pushed to it
  SubscriptionHeader * subscription = nullptr;
  WakeWords * wake = nullptr;
  uint32_t cluster = 0;
  uint32_t endpoint = 0;
  uint32_t incarnation = 0;
  bool reliable = false;
  bool reads_history = false;
  Gid gid{};

  uint64_t word() const noexcept { return endpoint_word(endpoint, incarnation); }
};

/// Consecutive readers of a ReaderList, valid until it is rebuilt.
class Readers {
public:
  Readers(const Reader * first, size_t count) noexcept : first_(first), count_(count) {}

  const Reader * begin() const noexcept { return first_; }
  const Reader * end() const noexcept { return first_ + count_; }
  size_t size() const noexcept { return count_; }

private:
  const Reader * first_;
  size_t count_;
};

/// The readers of a publisher, in a private list that is rebuilt when rows of its topic changed.
/// New ones get a seat. Its addresses are valid while the publisher's phase is odd (see
/// docs/design/rows_seats_hands.md).
class ReaderList {
public:
  ReaderList(Registry & registry, Cluster & cluster, TopicDsmHeader & dsm, EndpointEntry & own);

  /// At the begin of a phase: like refresh(), but forgets the list of the former phase, whose
  /// readers may be freed, if there is no memory for a new one.
  void begin_phase(const SeatStart & start) noexcept;
  /// Rebuilds the list if rows changed; seats of new readers begin at `start`, which is before the
  /// record in work. Where there is no memory for that, keeps the list of earlier in this phase.
  /// The load of `changes` is seq_cst: it must not be reordered before the caller's preceding
  /// seq_cst store of `phase`, `number` or `last`.
  void refresh(const SeatStart & start) noexcept;

  Readers all() const noexcept { return {readers_.data(), readers_.size()}; }
  /// The reader with this gid, or none. Takes O(log readers): a server has one reader per client.
  Readers with_gid(const Gid & gid) const noexcept;

  bool is_complete() const noexcept { return !obstacle_; }
  /// For a record that is published already while the list lacks readers: gives them seats, as far
  /// as there are, and asks all to look. Needs no memory.
  void serve_without_list(const SeatStart & start) noexcept;

  /// Throws Error{system|permission|corrupt|no_space|timeout} naming the topic if a reader cannot
  /// be resolved, or there is no SMEM for its seat, and std::bad_alloc if there was no memory.
  void require_all(const char * topic) const {
    if (obstacle_) {
      throw_obstacle(topic);
    }
  }

  /// True while a reader has, or may have, a claim on record `number`. The claims of a reader that
  /// cannot be resolved are invisible, so it may have one on any record.
  bool is_pinned(uint64_t number) const noexcept {
    for (const Reader & reader : readers_) {
      if (reading_.is(reader.subscription->reading.load(std::memory_order_seq_cst), number)) {
        return true;
      }
    }
    return is_any_hidden_;
  }

  /// True while a reader scans, or has or may have a claim on a record in [first, last].
  bool is_any_pinned(uint64_t first, uint64_t last) const noexcept {
    for (const Reader & reader : readers_) {
      const uint64_t word = reader.subscription->reading.load(std::memory_order_seq_cst);
      if (reading_.is_any_of(word, first, last)) {
        return true;
      }
    }
    return is_any_hidden_;
  }

private:
  [[noreturn]] void throw_obstacle(const std::string & topic) const;
  /// False if there is no memory.
  bool try_to_refresh(const SeatStart & start) noexcept;
  void rebuild(const SeatStart & start);
  void look_at_seats();
  void serve(uint32_t slot, const SeatStart & start) noexcept;
  /// Throws Error if the cluster cannot be mapped or the row is invalid.
  Reader resolve(const Peer & peer);
  /// False where its records are transferred and have no place in its cluster yet.
  bool can_reach(const Reader & reader) const noexcept;
  void give_seats(const SeatStart & start);
  Seat & free_seat();
  void grow_seats();
  void note_free(Seat & first, uint64_t bytes);
  void sort();

  Registry & registry_;
  Cluster & cluster_;
  TopicDsmHeader & dsm_;
  Peers peers_;
  const Reading reading_;
  std::vector<Reader> readers_;
  std::vector<uint32_t> by_gid_;  ///< indices of readers_, ordered by gid
  std::vector<Reader> next_;      ///< the next list while it is made; otherwise spare storage
  std::vector<std::pair<uint64_t, size_t>> by_word_;  ///< indices in next_, by endpoint_word()
  std::vector<Seat *> free_seats_;
  std::exception_ptr obstacle_;  ///< why a reader, or its seat, is missing from the list
  bool is_any_hidden_ = false;   ///< a reader could not be resolved
};

}  // namespace manycore
