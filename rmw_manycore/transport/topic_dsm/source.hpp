// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "transport/layout/subscription_layout.hpp"
#include "transport/layout/topic_dsm_layout.hpp"
#include "transport/registry/registry.hpp"

namespace manycore {

/// A topic DSM as one subscription sees it: finds, claims and releases records. One thread at a
/// time (the subscription's mutex). See docs/design/topic_dsm.md, Take.
class Source {
public:
  /// Which use of which entry of the source table.
  struct Use {
    uint32_t index;
    uint32_t incarnation;
  };
  /// Nullptr-like (operator bool) when the source leads nowhere.
  /// `subscription` has the gid, and the count of lost messages.
  Source(Registry & registry, SourceEntry & entry, Use use, EndpointEntry & subscription);

  explicit operator bool() const noexcept { return dsm_ != nullptr; }
  uint32_t index() const noexcept { return index_; }
  uint32_t incarnation() const noexcept { return incarnation_; }
  bool is(const SourceEntry & entry) const noexcept {
    return &entry == entry_ && entry.incarnation.load() == incarnation_;
  }

  /// Highest record number that needs no further look: taken, or in the backlog.
  uint64_t noted() const noexcept { return noted_; }
  /// A reply whose hint was displaced: counted as lost, and not to be delivered any more. Missing
  /// messages of other roles are counted by their sequence numbers, so those may still be
  /// delivered.
  bool is_given_up(uint64_t number) const noexcept;
  /// The full number of which a hint carries the low 28 bits; nothing when no such record was
  /// published, or the topic DSM may be gone.
  std::optional<uint64_t> published_number(uint64_t low_bits) noexcept;

  enum class ClaimResult { claimed, gone, not_ours, expired };
  struct View {
    const RecordDescriptor * record = nullptr;
    const uint8_t * data = nullptr;
  };
  /// On `claimed`, release() must follow; any other result has released already.
  ClaimResult claim(uint64_t number, View & view) noexcept;
  /// Ends a claim: everything up to `number` is done for this reader. True when the publisher is
  /// gone and its topic DSM may have waited for this reader only.
  bool release(uint64_t number) noexcept;
  /// The same without a claim.
  void skip(uint64_t number) noexcept;
  uint64_t taken() const noexcept { return entry_->taken.load(std::memory_order_relaxed); }

  struct Waiting {
    int64_t source_timestamp_ns;
    uint64_t number;
    uint32_t source;
    uint32_t incarnation;  ///< of the source
  };
  /// Step of a resync: appends the live records above noted() to `out`, in order, and notes them.
  void list_waiting(std::vector<Waiting> & out) noexcept;

  /// With no hint and no backlog left: counts what was lost since the last message accounted for.
  /// False while a hint is on its way.
  bool settle() noexcept;

  const Gid & publisher() const noexcept { return dsm_->gid; }
  uint32_t publisher_process() const noexcept { return dsm_->process; }
  uint32_t publisher_slot() const noexcept {
    return entry_->topic_dsm_endpoint.load(std::memory_order_relaxed);
  }

private:
  /// Of one generation; empty where the entry leads nowhere.
  struct Descriptors {
    RecordDescriptor * begin = nullptr;
    uint64_t count = 0;
  };

  static uint64_t full_number(uint64_t low_bits, uint64_t latest) noexcept;
  /// Highest record number published; under a claim.
  uint64_t last() const noexcept;
  /// The generation that holds `number`, or nullptr.
  const GenerationEntry * generation_of(uint64_t number) const noexcept;
  ClaimResult look_at(uint64_t number, View & view) noexcept;
  Descriptors descriptors_of(const GenerationEntry & generation) const noexcept;
  bool is_for_us(const RecordDescriptor & record) const noexcept;
  bool is_expired(const RecordDescriptor & record) const noexcept;
  /// The source is still this one, and open: to be asked after storing `reading`.
  bool may_look() const noexcept;
  void scan(const GenerationEntry & generation, uint64_t last, std::vector<Waiting> & out) noexcept;
  /// Counts messages up to this publication sequence number as lost where they are not accounted
  /// for.
  void count_missing(uint64_t last_sequence) noexcept;
  /// Raises SourceEntry::accounted; by how much.
  uint64_t account_for(uint64_t last_sequence) noexcept;
  /// The publisher is gone and everything it left has been taken.
  bool is_finished() const noexcept;
  void tell_waiting_publisher() noexcept;

  Cluster * cluster_ = nullptr;
  TopicDsmHeader * dsm_ = nullptr;
  SourceEntry * entry_;
  uint32_t index_;
  uint32_t incarnation_;
  uint64_t noted_ = 0;
  EndpointEntry * subscription_;
};

}  // namespace manycore
