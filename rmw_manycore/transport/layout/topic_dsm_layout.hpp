// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "platform/futex.hpp"
#include "transport/layout/endpoint.hpp"
#include "transport/layout/entry_blocks.hpp"
#include "transport/layout/segment_layout.hpp"

namespace manycore {

constexpr uint32_t max_generations = 8;
constexpr uint64_t no_record = 0;  ///< record numbers start at 1
/// Value of SourceEntry::reading that keeps the topic DSM and all its generations, but no record.
constexpr uint64_t every_record = UINT64_MAX;

/// One record of a topic DSM. Owned by the publisher; a reader looks at it only under its claim.
struct alignas(64) RecordDescriptor {
  std::atomic<uint64_t> number;  ///< no_record while free or being rewritten
  uint64_t offset;               ///< of the CDR bytes, in the publisher's cluster segment
  uint32_t size_bytes;
  uint32_t reserved;
  std::atomic<int64_t> source_timestamp_ns;  ///< sweepers look at it without a claim
  uint64_t publication_sequence_number;
  Correlation correlation;
};
static_assert(sizeof(RecordDescriptor) == 64);

/// One allocation of descriptors followed by data.
struct GenerationEntry {
  std::atomic<uint64_t> first;  ///< number of its first record; 0 = readers may not look into it
  /// Of descriptors, in the publisher's cluster segment; 0 = it holds no memory. Changed under the
  /// registry lock.
  std::atomic<uint64_t> offset;
  std::atomic<uint32_t> descriptor_count;  ///< power of two
  std::atomic<uint32_t> reserved;
  std::atomic<uint64_t> data_bytes;

  uint64_t extent_bytes() const noexcept {
    return uint64_t{descriptor_count.load(std::memory_order_relaxed)} * sizeof(RecordDescriptor) +
           data_bytes.load(std::memory_order_relaxed);
  }
};
static_assert(sizeof(GenerationEntry) == 32);

/// One reader of a topic DSM, as the publisher and the receive threads see it. All fields atomic:
/// read without the registry lock.
struct ReaderEntry {
  std::atomic<uint32_t> active;
  std::atomic<uint32_t> endpoint;      ///< slot of the subscription
  std::atomic<uint64_t> subscription;  ///< SegmentRef of its header
  std::atomic<uint64_t> source;        ///< SegmentRef of its source entry for this topic DSM
  std::atomic<uint32_t> source_index;
  std::atomic<uint32_t> source_incarnation;
};
static_assert(sizeof(ReaderEntry) == 32);

constexpr uint32_t readers_in_header = 14;

/// Head of a topic DSM: one writer, many readers.
struct TopicDsmHeader {
  std::atomic<uint32_t> magic;
  std::atomic<uint32_t> endpoint;     ///< slot of the publisher
  std::atomic<uint32_t> incarnation;  ///< of that slot
  std::atomic<uint32_t> orphan;       ///< its publisher is gone; freed once drained
  int64_t lifespan_ns;
  uint32_t depth;  ///< of the publisher's KEEP_LAST history
  uint8_t keep_all;
  uint8_t transient_local;
  uint8_t role;  ///< EndpointRole
  uint8_t reserved;
  uint32_t process;           ///< slot of the publisher's process
  uint32_t free_reader_from;  ///< no reader below this index is free; under the registry lock
  Gid gid;

  /// Written by the publisher at each message, read by everybody.
  alignas(64) std::atomic<uint64_t> last;  ///< highest record number published
  std::atomic<uint64_t> phase;             ///< odd while the publisher follows references
  /// Record numbers that carry no message, stored before and after `last`: see last_published().
  std::atomic<uint64_t> skipped_before;
  std::atomic<uint64_t> skipped_after;
  /// Raised by matchers whenever the reader table changes.
  alignas(64) std::atomic<uint64_t> match_generation;
  /// RELIABLE + KEEP_ALL: raised by readers at each release while `writer_waits`.
  FutexWord progress;
  std::atomic<uint32_t> writer_waits;

  alignas(64) GenerationEntry generations[max_generations];
  ReaderEntry readers[readers_in_header];
  EntryBlocks further_readers;
  /// Closing: readers below this index know that the publisher is gone; under the registry lock.
  uint32_t closed_before;
  /// Sweeping: readers below this index were looked at; under the registry lock.
  uint32_t swept_before;
};
static_assert(sizeof(TopicDsmHeader) == 1024);
static_assert(std::is_standard_layout_v<TopicDsmHeader>);

}  // namespace manycore
