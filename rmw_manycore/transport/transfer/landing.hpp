// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/layout/topic_dsm_layout.hpp"
#include "transport/layout/transfer_layout.hpp"
#include "transport/registry/cluster.hpp"

namespace manycore {

/// A topic DSM's header with its landing table, where it is transferred.
inline uint64_t header_bytes(Transfer transfer) noexcept {
  return sizeof(TopicDsmHeader) + (transfer == Transfer::dsm ? 0 : sizeof(LandingTable));
}
inline uint64_t header_bytes(const TopicDsmHeader & dsm) noexcept {
  return header_bytes(static_cast<Transfer>(dsm.transfer));
}

/// Nullptr unless the topic DSM is transferred. `cluster`: that of the topic DSM.
inline LandingTable * landing_table(const Cluster & cluster, TopicDsmHeader & dsm) noexcept {
  if (dsm.transfer == static_cast<uint8_t>(Transfer::dsm)) {
    return nullptr;
  }
  return cluster.find<LandingTable>(cluster.ref_of(&dsm).offset() + sizeof(TopicDsmHeader));
}

/// Bytes of a landing for a topic DSM, which has one generation for ever.
inline uint64_t landing_bytes(const TopicDsmHeader & dsm) noexcept {
  const GenerationEntry & only = dsm.generations[0];
  return sizeof(LandingHeader) +
         uint64_t{only.descriptor_count.load(std::memory_order_relaxed)} * sizeof(uint64_t) +
         only.data_bytes.load(std::memory_order_relaxed);
}

/// A landing in a cluster that this process has mapped. References to it are followed as those to
/// its topic DSM: under a claim or in a phase. See docs/design/transfers.md.
class Landing {
public:
  Landing() = default;
  /// Empty where `dsm` has no landing in `receiver`. `cluster`: that of the topic DSM.
  static Landing of(
    const Cluster & cluster, TopicDsmHeader & dsm, const Cluster & receiver) noexcept;

  explicit operator bool() const noexcept { return header_ != nullptr; }
  LandingHeader & header() const noexcept { return *header_; }

  bool has(uint64_t number) const noexcept {
    return mark_of(number).load(std::memory_order_acquire) == number;
  }
  /// Nullptr when the place is out of bounds.
  uint8_t * find(const RecordPlace & place) const noexcept;

  // Of a reader.
  uint64_t arrived() const noexcept { return header_->arrived.load(std::memory_order_seq_cst); }
  /// True when all up to `published` is here up to `known`, or never will be.
  bool is_settled(uint64_t published, uint64_t known) const noexcept;

  // Of the thread that fills it.
  void arrive(uint64_t number) const noexcept;
  void give_up(uint64_t number) const noexcept;

private:
  std::atomic<uint64_t> & mark_of(uint64_t number) const noexcept {
    return header_->marks()[number & mark_mask_];
  }
  void note_done(uint64_t number) const noexcept;

  LandingHeader * header_ = nullptr;
  uint64_t mark_mask_ = 0;
  uint8_t * data_ = nullptr;
  uint64_t data_bytes_ = 0;
};

}  // namespace manycore
