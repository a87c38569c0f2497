// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "transport/layout/subscription_layout.hpp"
#include "transport/layout/topic_dsm_layout.hpp"
#include "transport/peers/peers.hpp"
#include "transport/queue/reading.hpp"
#include "transport/topic_dsm/last_published.hpp"
#include "transport/topic_dsm/seat_table.hpp"
#include "transport/transfer/transfer.hpp"

namespace manycore {

/// A topic DSM as seen by one subscription: finds, claims and releases records. Used by one thread
/// at a time (the subscription's mutex). See docs/design/topic_dsm.md, Take.
///
/// Each look is one word in the subscription's header, `reading`, which names this publisher. After
/// it is stored, the publisher's row shows whether the topic DSM is there
/// (docs/model/topic_dsm.pml).
class Source {
public:
  /// The result is false (operator bool) if the cluster cannot be mapped, or the row is invalid.
  Source(
    Registry & registry, const Peer & publisher, SubscriptionHeader & header,
    EndpointEntry & subscription);

  explicit operator bool() const noexcept { return dsm_ != nullptr; }
  uint32_t slot() const noexcept { return slot_; }
  uint32_t incarnation() const noexcept { return incarnation_; }
  /// False once the slot belongs to another endpoint.
  bool is_current() const noexcept {
    return row_->slot.incarnation.load(std::memory_order_relaxed) == incarnation_;
  }
  /// How a hint, or a listed record, names a record of this publisher.
  Hint hint_of(uint64_t number) const noexcept { return {slot_, incarnation_, number}; }

  /// What to claim.
  struct Wanted {
    uint64_t number;    ///< of a hint: its low bits
    bool is_from_hint;  ///< then it may be noted already
  };

  enum class ClaimResult : uint8_t { claimed, gone, not_ours, expired };
  struct View {
    const RecordDescriptor * record = nullptr;
    const uint8_t * data = nullptr;
    uint64_t number = no_record;
    ChunkHead * chunk = nullptr;  ///< of the record, unless it lies in the ring
    bool is_for_one_reader = false;
  };
  struct Claimed {
    ClaimResult result;
    bool is_finished;  ///< as release() returns
  };
  /// After `claimed` the caller must call release(); every other result has released already.
  Claimed claim(const Wanted & wanted, View & view) noexcept;
  /// Ends a claim: the reader is done with all records up to `number`. True if the publisher is
  /// gone and its topic DSM may have been waiting for this reader only.
  bool release(uint64_t number) noexcept;
  /// Like release(), without a claim.
  bool skip(uint64_t number) noexcept;
  /// The reader is done with all records up to this number.
  uint64_t taken() const noexcept { return taken_; }

  struct Waiting {
    int64_t source_timestamp_ns;
    uint64_t number;
    uint32_t publisher;    ///< slot
    uint32_t incarnation;  ///< of that slot
  };
  /// Step of a resync: appends the live records that were not noted to `out` in order, and notes
  /// them. True if the topic DSM may have been waiting for this look. Throws std::bad_alloc, and
  /// appends and notes none then.
  bool list_waiting(std::vector<Waiting> & out);

  enum class Settled : uint8_t {
    no,  ///< a hint may still be on its way, or the topic DSM is being freed
    yes,
    finished,  ///< and its topic DSM, whose publisher is gone, waits for this reader no more
  };
  /// Counts what was lost since the last message accounted for. Called when queue and backlog are
  /// empty.
  Settled settle() noexcept;

  const Gid & publisher() const noexcept { return dsm_->gid; }
  const Slot & row() const noexcept { return row_->slot; }
  const Cluster & cluster() const noexcept { return *cluster_; }
  uint32_t publisher_process() const noexcept { return dsm_->process; }

private:
  /// Descriptors of one generation; empty if its entry is invalid.
  struct Descriptors {
    RecordDescriptor * begin = nullptr;
    uint64_t count = 0;
  };

  /// Requires a claim.
  transfer::Arrived arrived() const noexcept { return {*cluster_, *dsm_, own_cluster_}; }
  /// Highest record number published for this subscription, or, where transferred, arrived.
  /// Requires a claim.
  uint64_t last() const noexcept;
  /// The open generation that holds `number`, or nullptr.
  const GenerationEntry * generation_of(uint64_t number) const noexcept;
  ClaimResult look_at(uint64_t number, View & view) noexcept;
  Descriptors descriptors_of(const GenerationEntry & generation) const noexcept;
  bool is_for_us(const RecordDescriptor & record) const noexcept;
  bool is_expired(const RecordDescriptor & record) const noexcept;
  /// Begins a look, which ends with end_look(). False if the topic DSM is not there.
  bool begin_look(uint64_t word) noexcept;
  /// The last access to the topic DSM was before. True if it may have been waiting for this look.
  bool end_look() noexcept;
  bool may_look() const noexcept;
  /// Finds the seat, from then on the place of what is taken.
  void meet() noexcept;
  /// The newest record for this reader, and its sequence number. Requires a claim.
  LastPublished last_published() const noexcept;
  bool has_announced_all() const noexcept;
  bool is_misnamed(const Wanted & wanted, ClaimResult result) const noexcept;
  /// Full number of what is wanted; no_record if no such record was published.
  uint64_t number_of(const Wanted & wanted) const noexcept;
  /// Release without the end of the look. True if the publisher is gone, and owes nothing more.
  bool note_taken(uint64_t number) noexcept;
  /// Notes all records up to the newest one.
  void scan_all(std::vector<Waiting> & out);
  void scan(
    const GenerationEntry & generation, const transfer::Arrived & arrived, uint64_t last,
    std::vector<Waiting> & out);
  /// Counts messages up to this publication sequence number as lost, unless they are accounted for.
  void count_lost(uint64_t last_sequence) noexcept;
  /// Counts messages before a newer one that was found.
  void count_gap(uint64_t found_sequence) noexcept;
  /// Raises Seat::accounted; returns by how much.
  uint64_t account_for(uint64_t last_sequence) noexcept;
  /// True if the publisher is gone and everything it left is taken.
  bool is_finished() const noexcept;
  bool is_known_finished() const noexcept;
  bool may_take() const noexcept;

  const EndpointEntry * row_;
  uint32_t slot_;
  uint32_t incarnation_;
  uint64_t reader_;     ///< endpoint_word() of the subscription
  bool reads_history_;  ///< from its beginning, and not from where the seat begins
  Cluster * cluster_ = nullptr;
  Cluster * own_cluster_ = nullptr;
  TopicDsmHeader * dsm_ = nullptr;
  Seat * seat_ = nullptr;       ///< unless the publisher has given none yet
  uint64_t noted_ = no_record;  ///< highest record number that is taken or in the backlog
  uint64_t taken_ = no_record;
  SubscriptionHeader * header_;
  EndpointEntry * subscription_;
};

}  // namespace manycore
