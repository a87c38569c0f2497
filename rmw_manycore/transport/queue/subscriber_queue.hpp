// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "transport/layout/subscription_layout.hpp"

namespace manycore {

/// "Source `source` has record `number` for you." Never trusted: see docs/design/topic_dsm.md.
struct Hint {
  uint32_t source = 0;              ///< index in the subscription's source table, 14 bits
  uint32_t source_incarnation = 0;  ///< low 6 bits count
  uint64_t number = 0;              ///< low 28 bits count

  static constexpr uint32_t source_limit = 1u << 14;
  static constexpr uint32_t incarnation_mask = (1u << 6) - 1;
  static constexpr uint64_t number_mask = (uint64_t{1} << 28) - 1;
};

namespace subscriber_queue {

/// One slot: lap of its position (16 bits) | source incarnation (6) | source (14) | number (28).
/// The lap makes a slot's value differ at each use, so that a delayed pusher's exchange fails.
inline uint64_t encode(uint64_t lap, const Hint & hint) noexcept {
  return lap << 48 | uint64_t{hint.source_incarnation & Hint::incarnation_mask} << 42 |
         uint64_t{hint.source} << 28 | (hint.number & Hint::number_mask);
}

inline Hint decode(uint64_t word) noexcept {
  return {
    static_cast<uint32_t>(word >> 28) & (Hint::source_limit - 1),
    static_cast<uint32_t>(word >> 42) & Hint::incarnation_mask, word & Hint::number_mask};
}

/// Slots of one queue, and the arithmetic of positions.
class Slots {
public:
  explicit Slots(SubscriptionHeader & header) noexcept
  : slots_(header.slots()), log2_(header.slot_count_log2 & 31) {}

  std::atomic<uint64_t> & at(uint64_t position) const noexcept {
    return slots_[position & ((uint64_t{1} << log2_) - 1)];
  }
  uint64_t lap(uint64_t position) const noexcept { return (position >> log2_) & 0xffff; }
  bool filled(uint64_t word, uint64_t position) const noexcept {
    return word >> 48 == lap(position);
  }

private:
  std::atomic<uint64_t> * slots_;
  uint32_t log2_;
};

/// Once, before the subscription is known to anybody: lap 0 is "never filled", positions start at
/// lap 1.
inline void initialize(SubscriptionHeader & header) noexcept {
  const uint64_t count = uint64_t{1} << header.slot_count_log2;
  for (uint64_t i = 0; i < count; ++i) {
    header.slots()[i].store(0, std::memory_order_relaxed);
  }
  header.head.store(count, std::memory_order_relaxed);
  header.tail.store(count, std::memory_order_relaxed);
}

/// Step 2 of Fig. 4 (or step 1 inside a cluster): appends a hint, displacing the oldest when the
/// queue holds `depth`. Any number of pushers in any processes; each may die at any instruction. A
/// full KEEP_ALL queue displaces nothing: `resync` tells the subscriber to look for itself.
///
/// The exchange on the slot is the push; whoever finds a filled slot at `tail` moves `tail` on, so
/// a pusher that died in between holds nobody up. `on_displaced(Hint)` is called for each that it
/// displaces. True when those that wait for the subscription's events have to look, too.
template<typename OnDisplaced>
bool push(SubscriptionHeader & header, const Hint & hint, OnDisplaced on_displaced) noexcept {
  // Each attempt that fails was overtaken by another pusher; only damage makes so many fail.
  constexpr int most_attempts = 10'000;
  bool changes_events = header.note_arrival();
  const Slots slots(header);
  for (int attempt = 0; attempt < most_attempts; ++attempt) {
    uint64_t tail = header.tail.load(std::memory_order_acquire);
    std::atomic<uint64_t> & slot = slots.at(tail);
    uint64_t word = slot.load(std::memory_order_acquire);
    if (slots.filled(word, tail)) {
      header.tail.compare_exchange_strong(tail, tail + 1, std::memory_order_seq_cst);
      continue;
    }
    uint64_t head = header.head.load(std::memory_order_acquire);
    if (header.tail.load(std::memory_order_acquire) != tail) {
      continue;  // `word` may be of a later lap, and `head` may have passed `tail`
    }
    if (tail - head >= header.depth) {
      if (header.keep_all != 0) {
        break;
      }
      const uint64_t oldest = slots.at(head).load(std::memory_order_acquire);
      if (header.head.compare_exchange_strong(head, head + 1, std::memory_order_acq_rel)) {
        header.dropped.fetch_add(1, std::memory_order_relaxed);
        on_displaced(decode(oldest));  // what stood there while nobody had moved `head`
        changes_events = true;
      }
      continue;
    }
    // seq_cst, as for `tail`: the pusher reads the watchers next (see Watchers).
    if (slot.compare_exchange_strong(
          word, encode(slots.lap(tail), hint), std::memory_order_seq_cst)) {
      header.tail.compare_exchange_strong(tail, tail + 1, std::memory_order_seq_cst);
      return changes_events;
    }
  }
  header.resync.store(1, std::memory_order_seq_cst);
  return changes_events;
}

/// Step 3: removes the oldest hint. One popper at a time; pushers may displace at the same time.
inline std::optional<Hint> pop(SubscriptionHeader & header) noexcept {
  const Slots slots(header);
  while (true) {
    uint64_t head = header.head.load(std::memory_order_acquire);
    const uint64_t word = slots.at(head).load(std::memory_order_acquire);
    if (header.head.load(std::memory_order_acquire) != head) {
      continue;  // displaced meanwhile
    }
    if (!slots.filled(word, head)) {
      return std::nullopt;
    }
    // A filled slot at `tail`: finish the push of a pusher that is late or dead, so that head <=
    // tail.
    uint64_t tail = head;
    header.tail.compare_exchange_strong(tail, head + 1, std::memory_order_acq_rel);
    // Success means that nobody displaced position `head`, so `word` was its content.
    if (header.head.compare_exchange_strong(head, head + 1, std::memory_order_acq_rel)) {
      return decode(word);
    }
  }
}

/// Hints in the queue, at some moment during the call.
inline uint64_t size(SubscriptionHeader & header) noexcept {
  const uint64_t head = header.head.load(std::memory_order_acquire);
  return header.tail.load(std::memory_order_acquire) - head;
}

/// seq_cst: a thread that finds it empty sleeps, having added itself to the watchers (see
/// Watchers).
inline bool empty(SubscriptionHeader & header) noexcept {
  const Slots slots(header);
  const uint64_t head = header.head.load(std::memory_order_acquire);
  return !slots.filled(slots.at(head).load(std::memory_order_seq_cst), head) &&
         header.head.load(std::memory_order_acquire) == head;
}

}  // namespace subscriber_queue
}  // namespace manycore
