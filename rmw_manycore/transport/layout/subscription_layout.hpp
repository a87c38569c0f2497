// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/layout/deadline_clock.hpp"
#include "transport/layout/entry_blocks.hpp"
#include "transport/layout/segment_layout.hpp"
#include "transport/layout/wake_words.hpp"

namespace manycore {

/// free -> joining -> active -> revoked -> free. Only `active` allows a claim; `joining` until the
/// publisher can know of the reader.
enum class SourceState : uint32_t { free, joining, active, revoked };

/// A topic DSM as seen from one subscription. The cache line is written by the subscriber per
/// message.
struct alignas(64) SourceEntry {
  std::atomic<SourceState> state;
  std::atomic<uint32_t> incarnation;  ///< raised at each use of this entry
  std::atomic<uint64_t> topic_dsm;    ///< SegmentRef of its header
  std::atomic<uint32_t> topic_dsm_endpoint;
  std::atomic<uint32_t> topic_dsm_incarnation;
  std::atomic<uint64_t> taken;    ///< all records up to this number are done for this reader
  std::atomic<uint64_t> reading;  ///< record being read: the claim; no_record or every_record else
  std::atomic<uint64_t> reader;   ///< SegmentRef of the ReaderEntry
  /// Messages of the publisher that were published before the match, taken, expired or counted as
  /// lost: all up to this publication sequence number. The subscriber's under its claim; the
  /// sweeper's once the source is revoked and nothing is claimed.
  std::atomic<uint64_t> accounted;
  std::atomic<uint64_t>
    displaced;  ///< newest hint that was displaced, as in its queue slot; 0 = none
};
static_assert(sizeof(SourceEntry) == 64);

/// Head of a subscription; the queue's slots follow it.
struct SubscriptionHeader {
  std::atomic<uint32_t> magic;
  std::atomic<uint32_t> endpoint;     ///< slot of the subscription
  std::atomic<uint32_t> incarnation;  ///< of that slot
  std::atomic<uint32_t> process;      ///< slot of its process
  uint32_t depth;                     ///< capacity of the queue
  uint32_t slot_count_log2;           ///< slots are a power of two, at least depth
  uint8_t keep_all;
  uint8_t has_deadline;
  uint8_t reserved[2];
  std::atomic<uint32_t> resync;             ///< hints may be missing: scan the sources
  std::atomic<uint64_t> source_generation;  ///< raised whenever the source table changes
  std::atomic<uint64_t> dropped;            ///< hints that pushers displaced
  /// Messages lost minus hints dropped when both were known exactly last: see lost_so_far().
  std::atomic<uint64_t> lost_beside_dropped;

  alignas(64) std::atomic<uint64_t> head;
  alignas(64) std::atomic<uint64_t> tail;

  /// Arrivals, against the requested deadline; untouched without one.
  alignas(64) DeadlineClock deadline;
  int64_t deadline_ns;
  Watchers watchers;          ///< threads of its process that wait for arrivals
  uint32_t free_source_from;  ///< no source below this index is free; under the registry lock
  uint32_t closed_before;     ///< closing: sources below this index are revoked; under that lock

  /// True when it is the first that counts: before it no deadline was due.
  [[nodiscard]] bool note_arrival() noexcept {
    return has_deadline != 0 && deadline.touch(deadline_ns);
  }

  alignas(64) EntryBlocks sources;
  /// Sweeping: publishers of the sources below this index follow no reference to the subscription
  /// any more; under the registry lock.
  uint32_t swept_before;

  std::atomic<uint64_t> * slots() noexcept {
    return reinterpret_cast<std::atomic<uint64_t> *>(this + 1);
  }
};
static_assert(sizeof(SubscriptionHeader) == 384);
static_assert(offsetof(SubscriptionHeader, lost_beside_dropped) == 48);

constexpr uint32_t keep_all_capacity = 1024;  ///< hints; beyond it the subscriber scans its sources

}  // namespace manycore
