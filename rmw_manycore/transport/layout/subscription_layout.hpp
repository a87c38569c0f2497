// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "transport/layout/deadline_clock.hpp"
#include "transport/layout/segment_layout.hpp"
#include "transport/layout/wake_words.hpp"

namespace manycore {

/// Number of hints that pushers displaced from a queue.
struct DisplacedCount {
  uint64_t hints;
  bool is_exact;  ///< else it may be too low
};

/// Head of a subscription. The slots of its queue follow.
struct SubscriptionHeader {
  std::atomic<uint32_t> magic;
  std::atomic<uint32_t> endpoint;     ///< slot of the subscription
  std::atomic<uint32_t> incarnation;  ///< of that slot
  std::atomic<uint32_t> process;      ///< slot of the subscription's process
  uint32_t depth;                     ///< queue capacity in hints
  uint32_t slot_count_log2;           ///< slot count: a power of two, at least depth
  uint8_t keep_all;
  uint8_t has_deadline;
  uint8_t reserved[2];
  std::atomic<uint32_t> resync;  ///< hints may be missing: scan all sources
  /// Missed messages minus the displaced hints when both were last known exactly; see
  /// missed_so_far().
  std::atomic<uint64_t> missed_beside_displaced;

  alignas(64) std::atomic<uint64_t> head;
  /// Pops that have begun, and that have moved `head`; written by the popper. What else moved it
  /// are displacements, which therefore need no counter of their own.
  std::atomic<uint64_t> pops_begun;
  std::atomic<uint64_t> pops_done;
  /// The record that the subscription is looking at, as encoded by Reading; 0 = none. It counts
  /// while the subscription's row is live.
  std::atomic<uint64_t> reading;
  alignas(64) std::atomic<uint64_t> tail;

  /// Clock of the requested deadline, touched by each arrival; unused without a deadline.
  alignas(64) DeadlineClock deadline;
  int64_t deadline_ns;
  Watchers watchers;  ///< threads of its process that wait for arrivals

  /// Records an arrival. Returns true for the first one, before which no deadline was due.
  [[nodiscard]] bool note_arrival() noexcept {
    return has_deadline != 0 && deadline.touch(deadline_ns);
  }

  /// The moves of `head` that were no pops. Not exact if pops overtake each attempt, or if the
  /// popper stands in one, or died there: then those are missing that moved nothing before `head`
  /// was loaded.
  DisplacedCount displaced() const noexcept {
    constexpr int max_attempts = 100;
    const uint64_t first = uint64_t{1} << (slot_count_log2 & 31);
    uint64_t moves = 0;
    uint64_t begun = 0;
    for (int attempt = 0; attempt < max_attempts; ++attempt) {
      // In this order: equal numbers of pops done before and begun after belong to this `head`.
      const uint64_t done = pops_done.load(std::memory_order_acquire);
      moves = head.load(std::memory_order_acquire) - first;
      begun = pops_begun.load(std::memory_order_relaxed);
      if (begun == done) {
        return {moves - std::min(moves, begun), true};
      }
    }
    return {moves - std::min(moves, begun), false};
  }

  std::atomic<uint64_t> * slots() noexcept {
    return reinterpret_cast<std::atomic<uint64_t> *>(this + 1);
  }
};
static_assert(sizeof(SubscriptionHeader) == 256);
static_assert(offsetof(SubscriptionHeader, missed_beside_displaced) == 32);

/// Size of a subscription's head with a queue of 2^`slot_count_log2` slots.
constexpr uint64_t subscription_block_bytes(uint32_t slot_count_log2) noexcept {
  return sizeof(SubscriptionHeader) + (uint64_t{8} << (slot_count_log2 & 31));
}
inline uint64_t block_bytes(const SubscriptionHeader & header) noexcept {
  return subscription_block_bytes(header.slot_count_log2);
}

/// Hints; when the queue overflows, the subscriber resyncs.
constexpr uint32_t keep_all_capacity = 1024;

}  // namespace manycore
