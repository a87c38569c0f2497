// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "transport/layout/subscription_layout.hpp"
#include "transport/queue/hint.hpp"

namespace manycore {

namespace subscriber_queue {

/// Word of a slot: lap of its position (16 bits) | hint (48). The lap makes the word differ at each
/// reuse of the slot, so a delayed pusher's exchange fails.
inline uint64_t encode(uint64_t lap, const Hint & hint) noexcept {
  return lap << Hint::bits | hint.word();
}

inline Hint decode(uint64_t word) noexcept { return Hint::of(word); }

/// The slots of one queue, addressed by position.
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

/// Called once, in cleared memory, before the subscription is visible to others. Lap 0 means "never
/// filled", so positions start at lap 1.
inline void initialize(SubscriptionHeader & header) noexcept {
  const uint64_t count = uint64_t{1} << header.slot_count_log2;
  header.head.store(count, std::memory_order_relaxed);
  header.tail.store(count, std::memory_order_relaxed);
}

/// Step 2 of ROS-lite2 Fig. 4 (step 1 inside a cluster): appends a hint and displaces the oldest
/// one when the queue holds `depth` hints. Any number of pushers in any processes may run
/// concurrently, and each may die at any instruction. A full KEEP_ALL queue displaces nothing; it
/// sets `resync`, so the subscriber scans its sources.
///
/// The push takes effect with the exchange on the slot. A pusher that finds the slot at `tail`
/// filled advances `tail`, so a pusher that died between the two exchanges blocks no other. Returns
/// true when threads waiting for the subscription's events must be woken as well.
inline bool push(SubscriptionHeader & header, const Hint & hint) noexcept {
  // A failed attempt was overtaken by another pusher; only a damaged queue fails this often.
  constexpr int max_attempts = 10'000;
  bool changes_events = header.note_arrival();
  const Slots slots(header);
  for (int attempt = 0; attempt < max_attempts; ++attempt) {
    uint64_t tail = header.tail.load(std::memory_order_acquire);
    std::atomic<uint64_t> & slot = slots.at(tail);
    uint64_t word = slot.load(std::memory_order_acquire);
    if (slots.filled(word, tail)) {
      header.tail.compare_exchange_strong(tail, tail + 1, std::memory_order_seq_cst);
      continue;
    }
    uint64_t head = header.head.load(std::memory_order_acquire);
    if (header.tail.load(std::memory_order_acquire) != tail) {
      continue;  // `word` may belong to a later lap, and `head` may have passed `tail`
    }
    if (tail - head >= header.depth) {
      if (header.keep_all != 0) {
        break;
      }
      if (header.head.compare_exchange_strong(head, head + 1, std::memory_order_acq_rel)) {
        changes_events = true;
      }
      continue;
    }
    // seq_cst, as for `tail`: the pusher loads the watchers next (see Watchers).
    if (slot.compare_exchange_strong(
          word, encode(slots.lap(tail), hint), std::memory_order_seq_cst)) {
      header.tail.compare_exchange_strong(tail, tail + 1, std::memory_order_seq_cst);
      return changes_events;
    }
  }
  header.resync.store(1, std::memory_order_seq_cst);
  return changes_events;
}

/// Step 3: removes the oldest hint. One popper at a time; pushers may displace hints concurrently.
inline std::optional<Hint> pop(SubscriptionHeader & header) noexcept {
  const Slots slots(header);
  const uint64_t pops = header.pops_done.load(std::memory_order_relaxed);
  while (true) {
    uint64_t head = header.head.load(std::memory_order_acquire);
    const uint64_t word = slots.at(head).load(std::memory_order_acquire);
    if (header.head.load(std::memory_order_acquire) != head) {
      continue;  // a pusher displaced it meanwhile
    }
    if (!slots.filled(word, head)) {
      header.pops_begun.store(pops, std::memory_order_relaxed);
      return std::nullopt;
    }
    // The slot may be filled while `tail` still points at it: advance `tail` for a pusher that is
    // late or dead, so that head <= tail.
    uint64_t tail = head;
    header.tail.compare_exchange_strong(tail, head + 1, std::memory_order_acq_rel);
    // Before the exchange, whose release makes it known to a reader of the moved `head`.
    header.pops_begun.store(pops + 1, std::memory_order_relaxed);
    // Success means that position `head` was not displaced, so `word` is its content.
    if (header.head.compare_exchange_strong(head, head + 1, std::memory_order_acq_rel)) {
      header.pops_done.store(pops + 1, std::memory_order_release);
      return decode(word);
    }
  }
}

/// Number of hints at some moment during the call.
inline uint64_t size(SubscriptionHeader & header) noexcept {
  const uint64_t head = header.head.load(std::memory_order_acquire);
  return header.tail.load(std::memory_order_acquire) - head;
}

/// seq_cst: a thread adds itself to the watchers, and sleeps if it finds the queue empty (see
/// Watchers).
inline bool empty(SubscriptionHeader & header) noexcept {
  const Slots slots(header);
  const uint64_t head = header.head.load(std::memory_order_acquire);
  return !slots.filled(slots.at(head).load(std::memory_order_seq_cst), head) &&
         header.head.load(std::memory_order_acquire) == head;
}

}  // namespace subscriber_queue
}  // namespace manycore
