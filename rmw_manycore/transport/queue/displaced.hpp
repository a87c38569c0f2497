// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>

#include "transport/queue/subscriber_queue.hpp"

namespace manycore {

/// SourceEntry::displaced: the newest record of a source whose hint was displaced. Like the hint it
/// holds the low bits of record number and source incarnation; a pusher may come late, when the
/// entry is another source's.
struct Displaced {
  static constexpr uint64_t some = uint64_t{1} << 63;

  /// By any pusher, in any order: within an incarnation only ever towards newer numbers.
  static void raise(std::atomic<uint64_t> & displaced, const Hint & hint) noexcept {
    const uint64_t word = encode(hint.source_incarnation, hint.number);
    uint64_t known = displaced.load(std::memory_order_relaxed);
    while (is_newer(word, known) &&
           !displaced.compare_exchange_weak(known, word, std::memory_order_release)) {
    }
  }
  /// True when the hint of this record was displaced: that record's, or that of a later one, as the
  /// queue drops a source's hints in order.
  static bool covers(
    const std::atomic<uint64_t> & displaced, uint32_t source_incarnation,
    uint64_t number) noexcept {
    const std::optional<uint64_t> newest = read(displaced, source_incarnation);
    return newest && ((*newest - number) & Hint::number_mask) <= Hint::number_mask / 2;
  }
  /// Low bits of its number.
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
