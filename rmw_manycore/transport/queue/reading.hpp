// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/queue/hint.hpp"

namespace manycore {

/// Encoding of SubscriptionHeader::reading: what a subscription is looking at, as a hint names it,
/// so a claim needs no more than its hint. Only the low bits of a number are stored, so other
/// records with the same bits count as pinned, too; harmless.
class Reading {
public:
  static constexpr uint64_t nothing = 0;

  static uint64_t of(const Hint & hint) noexcept { return some | hint.word(); }
  /// Keeps the header of the topic DSM, but no generation.
  static uint64_t header_only(uint32_t publisher, uint32_t incarnation) noexcept {
    return header | of({publisher, incarnation, 0});
  }
  /// Keeps the generation that begins with a record, but no record.
  static uint64_t generation(const Hint & first) noexcept { return whole | of(first); }

  /// Records of one publisher: announces which one is read.
  Reading(uint32_t publisher, uint32_t incarnation) noexcept
  : of_publisher_(of({publisher, incarnation, 0})) {}

  bool is_any(uint64_t word) const noexcept {
    return (word & ~(header | whole | Hint::number_mask)) == of_publisher_;
  }
  bool is(uint64_t word, uint64_t number) const noexcept {
    return word == (of_publisher_ | (number & Hint::number_mask));
  }
  /// Any of the records from `first` to `last`, or a generation that begins with one.
  bool is_any_of(uint64_t word, uint64_t first, uint64_t last) const noexcept {
    return is_any(word) && (word & header) == 0 &&
           (last - first >= Hint::number_mask ||
            ((word - first) & Hint::number_mask) <= last - first);
  }

private:
  static constexpr uint64_t some = uint64_t{1} << 63;
  static constexpr uint64_t header = uint64_t{1} << 62;
  static constexpr uint64_t whole = uint64_t{1} << 61;

  uint64_t of_publisher_;
};

}  // namespace manycore
