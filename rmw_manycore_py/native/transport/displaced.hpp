// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>

#include "transport/subscriber_queue.hpp"

namespace manycore {

/// SourceEntry::displaced: the newest record of a source whose hint was displaced. Holds the number's low bits, like the
/// hint, and a bit that says so.
struct Displaced {
  static constexpr uint64_t some = uint64_t{1} << 63;

  /// By any pusher, in any order: only ever towards newer numbers.
  static void raise(std::atomic<uint64_t> & displaced, uint64_t low_bits) noexcept {
    uint64_t known = displaced.load(std::memory_order_relaxed);
    while (((known & some) == 0 || is_newer(low_bits, known)) &&
           !displaced.compare_exchange_weak(known, some | low_bits, std::memory_order_release)) {
    }
  }
  /// Low bits of its number.
  static std::optional<uint64_t> read(const std::atomic<uint64_t> & displaced) noexcept {
    const uint64_t word = displaced.load(std::memory_order_acquire);
    return (word & some) == 0 ? std::nullopt : std::optional(word & Hint::number_mask);
  }

private:
  static bool is_newer(uint64_t a, uint64_t b) noexcept {
    const uint64_t ahead = (a - b) & Hint::number_mask;
    return ahead != 0 && ahead <= Hint::number_mask / 2;
  }
};

}  // namespace manycore
