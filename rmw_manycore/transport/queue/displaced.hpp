// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>

#include "transport/queue/subscriber_queue.hpp"

namespace manycore {

/// Encoding of SourceEntry::displaced: the newest record of a source whose hint was displaced from
/// the queue. Like a hint, it holds only the low bits of record number and source incarnation; a
/// late pusher may write it after another source has taken the entry.
struct Displaced {
  static constexpr uint64_t some = uint64_t{1} << 63;

  /// Called by any pusher, in any order. Within an incarnation the number only increases.
  static void raise(std::atomic<uint64_t> & displaced, const Hint & hint) noexcept {
    const uint64_t word = encode(hint.source_incarnation, hint.number);
    uint64_t known = displaced.load(std::memory_order_relaxed);
    while (is_newer(word, known) &&
           !displaced.compare_exchange_weak(known, word, std::memory_order_release)) {
    }
  }
  /// True when the hint of this record, or of a later record of the same source, was displaced: the
  /// queue drops the hints of a source in order.
  static bool covers(
    const std::atomic<uint64_t> & displaced, uint32_t source_incarnation,
    uint64_t number) noexcept {
    const std::optional<uint64_t> newest = read(displaced, source_incarnation);
    return newest && ((*newest - number) & Hint::number_mask) <= Hint::number_mask / 2;
  }
  /// Low bits of the displaced record number, if it belongs to this incarnation.
  static std::optional<uint64_t> read(
    const std::atomic<uint64_t> & displaced, uint32_t source_incarnation) noexcept {
    const uint64_t word = displaced.load(std::memory_order_acquire);
    const uint64_t number = word & Hint::number_mask;
    return word == encode(source_incarnation, number) ? std::optional(number) : std::nullopt;
  }

private:
  static uint64_t encode(uint32_t incarnation, uint64_t number) noexcept {
    return some | uint64_t{incarnation & Hint::incarnation_mask} << 32 |
           (number & Hint::number_mask);
  }
  static bool is_newer(uint64_t word, uint64_t known) noexcept {
    const uint64_t ahead = (word - known) & Hint::number_mask;
    return word >> 32 != known >> 32 || (ahead != 0 && ahead <= Hint::number_mask / 2);
  }
};

}  // namespace manycore
