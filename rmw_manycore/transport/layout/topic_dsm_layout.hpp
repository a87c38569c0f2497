// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "platform/futex.hpp"
#include "transport/layout/endpoint.hpp"
#include "transport/layout/entry_blocks.hpp"
#include "transport/layout/segment_layout.hpp"

namespace manycore {

constexpr uint32_t max_generations = 8;
constexpr uint64_t no_record = 0;  ///< record numbers start at 1
/// In SourceEntry::reading: with this bit, the number of a generation's first record keeps the
/// generation, but no record.
constexpr uint64_t whole_generation = uint64_t{1} << 63;
/// Value of SourceEntry::reading that keeps the header of the topic DSM, but no generation.
constexpr uint64_t header_only = UINT64_MAX;

/// One record of a topic DSM. Written by the publisher; a reader accesses it only under its claim.
struct alignas(64) RecordDescriptor {
  std::atomic<uint64_t> number;  ///< no_record while free or being rewritten
  uint64_t offset;               ///< of the CDR bytes, in the publisher's cluster segment
  uint32_t size_bytes;
  uint32_t reserved;
  std::atomic<int64_t> source_timestamp_ns;  ///< atomic: sweepers read it without a claim
  uint64_t publication_sequence_number;
  Correlation correlation;
};
static_assert(sizeof(RecordDescriptor) == 64);

/// The memory behind a block of at least this size goes back to the system: a hole in the SMEM,
/// which takes time in each process that maps it.
constexpr uint64_t min_hole_bytes = 16 << 10;

/// One allocation of descriptors followed by record data.
struct GenerationEntry {
  std::atomic<uint64_t> first;  ///< number of its first record; 0 = closed to readers
  /// Offset of the descriptors in the publisher's cluster segment; 0 = no memory. Written under the
  /// registry lock.
  std::atomic<uint64_t> offset;
  std::atomic<uint32_t> descriptor_count;  ///< power of two
  uint32_t reserved;
  std::atomic<uint64_t> data_bytes;

  /// Offset of the data, which follow the descriptors.
  uint64_t data_offset() const noexcept {
    return offset.load(std::memory_order_relaxed) +
           uint64_t{descriptor_count.load(std::memory_order_relaxed)} * sizeof(RecordDescriptor);
  }
  /// Bytes of the whole generation.
  uint64_t extent_bytes() const noexcept {
    return uint64_t{descriptor_count.load(std::memory_order_relaxed)} * sizeof(RecordDescriptor) +
           data_bytes.load(std::memory_order_relaxed);
  }
};
static_assert(sizeof(GenerationEntry) == 32);

/// One reader of a topic DSM, as the publisher and the receive threads see it. All fields are
/// atomic because they are read without the registry lock.
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
  std::atomic<uint32_t> orphan;       ///< 1 = the publisher is gone; freed once it is unread
  int64_t lifespan_ns;
  uint32_t depth;  ///< of the publisher's KEEP_LAST history
  uint8_t keep_all;
  uint8_t transient_local;
  uint8_t role;               ///< EndpointRole
  uint8_t transfer;           ///< Transfer; unless dsm, a LandingTable follows this header
  uint32_t process;           ///< slot of the publisher's process
  uint32_t free_reader_from;  ///< no reader below this index is free; under the registry lock
  Gid gid;

  /// Written by the publisher for each message, read by all readers.
  alignas(64) std::atomic<uint64_t> last;  ///< highest record number published
  std::atomic<uint64_t> phase;             ///< odd while the publisher follows references
  /// Record numbers without a message, stored before and after `last`; see last_published().
  std::atomic<uint64_t> skipped_before;
  std::atomic<uint64_t> skipped_after;
  /// Incremented by matchers whenever the reader table changes.
  alignas(64) std::atomic<uint64_t> match_generation;
  /// RELIABLE + KEEP_ALL: incremented by readers at each release while `writer_waits` is set.
  FutexWord progress;
  std::atomic<uint32_t> writer_waits;

  alignas(64) GenerationEntry generations[max_generations];
  ReaderEntry readers[readers_in_header];
  EntryBlocks further_readers;
};
static_assert(sizeof(TopicDsmHeader) == 1024 && offsetof(TopicDsmHeader, gid) == 40);
static_assert(std::is_standard_layout_v<TopicDsmHeader>);

}  // namespace manycore
