// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "transport/layout/subscription_layout.hpp"
#include "transport/layout/topic_dsm_layout.hpp"
#include "transport/registry/registry.hpp"
#include "transport/transfer/transfer.hpp"

namespace manycore {

/// A topic DSM as seen by one subscription: finds, claims and releases records. Used by one thread
/// at a time (the subscription's mutex). See docs/design/topic_dsm.md, Take.
class Source {
public:
  /// An entry of the source table and its incarnation.
  struct Use {
    uint32_t index;
    uint32_t incarnation;
  };
  /// `subscription` provides the gid and the counter of lost messages. The result is false
  /// (operator bool) if the entry leads nowhere.
  Source(Registry & registry, SourceEntry & entry, Use use, EndpointEntry & subscription);

  explicit operator bool() const noexcept { return dsm_ != nullptr; }
  uint32_t index() const noexcept { return index_; }
  uint32_t incarnation() const noexcept { return incarnation_; }
  bool is(const SourceEntry & entry) const noexcept {
    return &entry == entry_ && entry.incarnation.load() == incarnation_;
  }

  /// Highest record number that is taken or in the backlog.
  uint64_t noted() const noexcept { return noted_; }
  /// True for a reply whose hint was displaced: it is counted as lost and must not be delivered any
  /// more. Messages of other roles are counted by sequence number, so they may still be delivered.
  bool is_given_up(uint64_t number) const noexcept;
  /// Full number of a record from the low 28 bits in a hint. Nothing if no such record was
  /// published, or the topic DSM may be freed.
  std::optional<uint64_t> published_number(uint64_t low_bits) noexcept;

  enum class ClaimResult { claimed, gone, not_ours, expired };
  struct View {
    const RecordDescriptor * record = nullptr;
    const uint8_t * data = nullptr;
  };
  struct Claimed {
    ClaimResult result;
    bool is_finished;  ///< as release() returns
  };
  /// After `claimed` the caller must call release(); every other result has released already.
  Claimed claim(uint64_t number, View & view) noexcept;
  /// Ends a claim: the reader is done with all records up to `number`. True if the publisher is
  /// gone and its topic DSM may have been waiting for this reader only.
  bool release(uint64_t number) noexcept;
  /// Like release(), without a claim.
  bool skip(uint64_t number) noexcept;
  uint64_t taken() const noexcept { return entry_->taken.load(std::memory_order_relaxed); }

  struct Waiting {
    int64_t source_timestamp_ns;
    uint64_t number;
    uint32_t source;
    uint32_t incarnation;  ///< of the source
  };
  /// Step of a resync: appends the live records above noted() to `out` in order, and raises
  /// noted().
  void list_waiting(std::vector<Waiting> & out) noexcept;

  enum class Settled : uint8_t {
    no,  ///< a hint may still be on its way, or the source was revoked
    yes,
    finished,  ///< and its topic DSM, whose publisher is gone, waits for this reader no more
  };
  /// Counts what was lost since the last message accounted for. Called when queue and backlog are
  /// empty.
  Settled settle() noexcept;

  const Gid & publisher() const noexcept { return dsm_->gid; }
  uint32_t publisher_process() const noexcept { return dsm_->process; }
  uint32_t publisher_slot() const noexcept {
    return entry_->topic_dsm_endpoint.load(std::memory_order_relaxed);
  }
  uint32_t publisher_incarnation() const noexcept {
    return entry_->topic_dsm_incarnation.load(std::memory_order_relaxed);
  }

private:
  /// Descriptors of one generation; empty if its entry is invalid.
  struct Descriptors {
    RecordDescriptor * begin = nullptr;
    uint64_t count = 0;
  };

  /// Requires a claim.
  transfer::Arrived arrived() const noexcept { return {*cluster_, *dsm_, own_cluster_}; }
  /// The open generation that holds `number`, or nullptr.
  const GenerationEntry * generation_of(uint64_t number) const noexcept;
  ClaimResult look_at(uint64_t number, View & view) noexcept;
  Descriptors descriptors_of(const GenerationEntry & generation) const noexcept;
  bool is_for_us(const RecordDescriptor & record) const noexcept;
  bool is_expired(const RecordDescriptor & record) const noexcept;
  /// True if the source is active and of the same incarnation. Call after storing `reading`.
  bool may_look() const noexcept;
  void scan(
    const GenerationEntry & generation, const transfer::Arrived & arrived, uint64_t last,
    std::vector<Waiting> & out) noexcept;
  /// Counts messages up to this publication sequence number as lost, unless they are accounted for.
  void count_missing(uint64_t last_sequence) noexcept;
  /// Raises SourceEntry::accounted; returns by how much.
  uint64_t account_for(uint64_t last_sequence) noexcept;
  /// True if the publisher is gone and everything it left is taken.
  bool is_finished() const noexcept;

  Cluster * cluster_ = nullptr;
  Cluster * own_cluster_ = nullptr;
  TopicDsmHeader * dsm_ = nullptr;
  SourceEntry * entry_;
  uint32_t index_;
  uint32_t incarnation_;
  uint64_t noted_ = 0;
  EndpointEntry * subscription_;
};

}  // namespace manycore
