// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "platform/futex.hpp"
#include "transport/layout/chunk_layout.hpp"
#include "transport/layout/endpoint.hpp"
#include "transport/layout/entry_blocks.hpp"
#include "transport/layout/seat.hpp"
#include "transport/layout/segment_layout.hpp"

namespace manycore {

constexpr uint32_t max_generations = 8;
constexpr uint64_t no_record = 0;  ///< record numbers start at 1

/// Where the bytes of a record lie.
enum class RecordMemory : uint32_t {
  ring,
  chunk,
  /// In a chunk, and one subscription only has been, or will ever be, owed the record.
  chunk_of_one_reader,
};

/// One record of a topic DSM. Written by the publisher; a reader accesses it only under its claim.
struct alignas(64) RecordDescriptor {
  std::atomic<uint64_t> number;  ///< no_record while free or being rewritten
  uint64_t offset;               ///< of the CDR bytes, in the publisher's cluster segment
  uint32_t size_bytes;
  std::atomic<RecordMemory> memory;
  int64_t source_timestamp_ns;           ///< CLOCK_REALTIME at publish
  uint64_t publication_sequence_number;  ///< of replies: among those to the same client
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

constexpr uint32_t seats_in_header = 14;

/// Head of a topic DSM: one writer, many readers.
struct TopicDsmHeader {
  std::atomic<uint32_t> magic;
  std::atomic<uint32_t> endpoint;     ///< slot of the publisher
  std::atomic<uint32_t> incarnation;  ///< of that slot
  /// 1 = the publisher is closed, and readers that are owed messages have been asked to look.
  std::atomic<uint32_t> orphan;
  int64_t lifespan_ns;
  uint32_t depth;  ///< of the publisher's KEEP_LAST history
  uint8_t keep_all;
  uint8_t transient_local;
  uint8_t role;      ///< EndpointRole
  uint8_t transfer;  ///< Transfer; unless dsm, a LandingTable follows this header
  uint32_t process;  ///< slot of the publisher's process
  uint32_t reserved;
  Gid gid;

  /// Written by the publisher for each message, read by all readers.
  alignas(64) std::atomic<uint64_t> last;  ///< highest record number published
  std::atomic<uint64_t> phase;             ///< odd while the publisher follows references
  /// Record numbers without a message, stored before and after `last`; see last_published().
  std::atomic<uint64_t> skipped_before;
  std::atomic<uint64_t> skipped_after;
  /// RELIABLE + KEEP_ALL: incremented by readers at each release while `writer_waits` is set.
  alignas(64) FutexWord progress;
  std::atomic<uint32_t> writer_waits;

  alignas(64) GenerationEntry generations[max_generations];
  EntryBlocks further_seats;
  EntryBlocks chunks;
  Seat seats[seats_in_header];
};
static_assert(sizeof(TopicDsmHeader) == 1536 && offsetof(TopicDsmHeader, gid) == 40);
static_assert(std::is_standard_layout_v<TopicDsmHeader>);

}  // namespace manycore
