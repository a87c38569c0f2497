// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>

namespace manycore {

/// Slot and incarnation of an endpoint in one word; 0 names none.
constexpr uint64_t endpoint_word(uint32_t slot, uint32_t incarnation) noexcept {
  return uint64_t{incarnation} << 32 | slot;
}
constexpr uint32_t slot_in(uint64_t word) noexcept { return static_cast<uint32_t>(word); }
constexpr uint32_t incarnation_in(uint64_t word) noexcept {
  return static_cast<uint32_t>(word >> 32);
}

/// What one subscription has read of a topic DSM. The publisher gives the seat, and its first
/// values, before it owes the subscription a record; once the publisher is closed, the process that
/// closed it does. From then on the subscription writes `taken` and `accounted`. The publisher
/// takes the seat back when the subscription's row is not live. See docs/model/seats.pml.
struct alignas(64) Seat {
  std::atomic<uint64_t> owner;  ///< endpoint_word() of the subscription; 0 = free
  std::atomic<uint64_t> taken;  ///< the reader is done with all records up to this number
  /// Publication sequence number up to which each message is accounted for: published before the
  /// seat was given, taken, expired, or counted as lost. After the publisher's end also written by
  /// the process that frees the topic DSM.
  std::atomic<uint64_t> accounted;
  /// Of a server: record of the newest reply to this client, then its number among the replies to
  /// this client. Written by the publisher in this order, read in the opposite one.
  std::atomic<uint64_t> last_reply;
  std::atomic<uint64_t> replies;
};
static_assert(sizeof(Seat) == 64);

}  // namespace manycore
