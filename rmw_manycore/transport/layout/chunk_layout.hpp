// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

namespace manycore {

/// A message of at least this size has a chunk of its own, which readers may hold.
constexpr uint64_t min_chunk_message_bytes = 64 << 10;

/// Holds that a chunk has room for; further readers copy.
constexpr uint32_t max_holders = 15;

/// How subscriptions read large messages of a topic, from the topic table.
enum class ZeroCopy : uint8_t {
  unset,      ///< as the program chooses
  sole,       ///< a sole reader in place, and writable; others copy
  read_only,  ///< each reader in place
  off,        ///< each reader copies
};

constexpr uint32_t chunk_magic = 0x4d43'434b;  // "MCCK"

/// Head of a chunk, the memory of one record. The bytes of the record follow it at `chunk_data`, so
/// that what follows their encapsulation of four bytes is aligned to 64.
struct alignas(64) ChunkHead {
  /// Processes that hold the record, as endpoint_word() encodes slot and incarnation; 0 = free. A
  /// process takes a free word, or that of a process that has ended, under its claim, and clears
  /// its own. The publisher only reads them.
  std::atomic<uint64_t> holders[max_holders];
  uint32_t magic;
  uint32_t data_begins_here;
};
static_assert(sizeof(ChunkHead) == 128);
constexpr uint64_t chunk_data = offsetof(ChunkHead, data_begins_here);

/// A chunk of a topic DSM, in its table of chunks.
struct ChunkEntry {
  /// Of the ChunkHead in the publisher's cluster segment; 0 = none. Written under the registry
  /// lock, last.
  std::atomic<uint64_t> offset;
  std::atomic<uint64_t> bytes;
};
static_assert(sizeof(ChunkEntry) == 16);

}  // namespace manycore
