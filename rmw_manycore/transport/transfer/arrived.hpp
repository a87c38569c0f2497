// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/transfer/landing.hpp"

namespace manycore::transfer {

/// What a subscription finds of a topic DSM: all that is published, or, where that is transferred
/// to its cluster, what has arrived there. Used under a claim.
class Arrived {
public:
  /// `cluster`: that of the topic DSM. `receiver`: nullptr if it cannot be mapped.
  Arrived(const Cluster & cluster, TopicDsmHeader & dsm, const Cluster * receiver) noexcept
  : cluster_(cluster),
    dsm_(dsm),
    is_moved_(dsm.transfer != static_cast<uint8_t>(Transfer::dsm) && &cluster != receiver) {
    if (is_moved_ && receiver != nullptr) {
      landing_ = Landing::of(cluster, dsm, *receiver);
    }
  }

  /// Highest record number.
  uint64_t last() const noexcept {
    if (!is_moved_) {
      return dsm_.last.load(std::memory_order_seq_cst);
    }
    return landing_ ? landing_.arrived() : no_record;
  }
  bool has(uint64_t number) const noexcept {
    return !is_moved_ || (landing_ && landing_.has(number));
  }
  /// The bytes of a record; nullptr if they are out of bounds or have not arrived.
  const uint8_t * find(
    const GenerationEntry & generation, const RecordDescriptor & record,
    uint64_t number) const noexcept {
    if (!is_moved_) {
      return cluster_.find<uint8_t>(record.offset, record.size_bytes);
    }
    return has(number)
             ? landing_.find({record.offset - generation.data_offset(), record.size_bytes})
             : nullptr;
  }
  /// True if no record up to `published` needs a look, given all up to `known` had one: none of
  /// them is on its way.
  bool is_settled(uint64_t published, uint64_t known) const noexcept {
    return is_moved_ ? landing_ && landing_.is_settled(published, known) : published <= known;
  }

private:
  const Cluster & cluster_;
  TopicDsmHeader & dsm_;
  const bool is_moved_;
  Landing landing_;
};

}  // namespace manycore::transfer
