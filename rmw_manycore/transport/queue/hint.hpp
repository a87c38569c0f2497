// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace manycore {

/// "Publisher `publisher` has record `number` for you." Names a record by few bits. May be stale,
/// duplicated or missing; the reader always verifies it against the publisher's row and the topic
/// DSM (docs/design/topic_dsm.md).
struct Hint {
  uint32_t publisher = 0;    ///< slot, 15 bits
  uint32_t incarnation = 0;  ///< of that slot; only the low 12 bits are stored
  uint64_t number = 0;       ///< only the low 21 bits are stored

  static constexpr uint32_t number_bits = 21;
  static constexpr uint32_t publisher_bits = 15;
  static constexpr uint32_t incarnation_bits = 12;
  static constexpr uint64_t number_mask = (uint64_t{1} << number_bits) - 1;
  static constexpr uint32_t publisher_mask = (1u << publisher_bits) - 1;
  static constexpr uint32_t incarnation_mask = (1u << incarnation_bits) - 1;
  static constexpr uint32_t bits = number_bits + publisher_bits + incarnation_bits;
  static_assert(bits == 48);

  /// In the low 48 bits of a word.
  uint64_t word() const noexcept {
    return uint64_t{incarnation & incarnation_mask} << (number_bits + publisher_bits) |
           uint64_t{publisher & publisher_mask} << number_bits | (number & number_mask);
  }
  static Hint of(uint64_t word) noexcept {
    return {
      static_cast<uint32_t>(word >> number_bits) & publisher_mask,
      static_cast<uint32_t>(word >> (number_bits + publisher_bits)) & incarnation_mask,
      word & number_mask};
  }
  bool is_of(uint32_t slot, uint32_t full_incarnation) const noexcept {
    return publisher == slot && ((incarnation ^ full_incarnation) & incarnation_mask) == 0;
  }
  /// The newest number with these low bits up to `latest`. A queued hint is less than one period
  /// (2^21) old, twice the largest depth, however long nothing was taken. If no number with these
  /// bits was published, the result wraps and is greater than `latest`.
  static uint64_t full_number(uint64_t low_bits, uint64_t latest) noexcept {
    return latest - ((latest - low_bits) & number_mask);
  }
};

}  // namespace manycore
