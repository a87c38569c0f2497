// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace manycore {

/// Increment whenever a struct in a *_layout.hpp, its meaning, or a file name changes.
constexpr uint32_t layout_version = 32;

constexpr uint64_t registry_magic = 0x4d43'5245'4749'5354;  // "MCREGIST"
constexpr uint64_t cluster_magic = 0x4d43'434c'5553'5452;   // "MCCLUSTR"
constexpr uint32_t topic_dsm_magic = 0x4d43'4453;           // "MCDS"
constexpr uint32_t subscription_magic = 0x4d43'5342;        // "MCSB"

constexpr uint32_t max_clusters = 64;  ///< receiver clusters are a 64-bit mask; Bostan has 20

/// First bytes of each segment. The creator stores `magic` last.
struct SegmentHeader {
  std::atomic<uint64_t> magic;
  uint32_t version;
  uint32_t cluster;  ///< 0 for the registry
  uint64_t size_bytes;
  uint64_t platform_nonce;  ///< the same in all segments of one platform
};
static_assert(sizeof(SegmentHeader) == 32 && std::atomic<uint64_t>::is_always_lock_free);

/// Reference to an object in a cluster segment.
struct SegmentRef {
  uint64_t word = 0;  ///< cluster in the upper 16 bits, offset in the lower 48; 0 = null

  static SegmentRef make(uint32_t cluster, uint64_t offset) noexcept {
    return {uint64_t{cluster} << 48 | offset};
  }
  uint32_t cluster() const noexcept { return static_cast<uint32_t>(word >> 48); }
  uint64_t offset() const noexcept { return word & ((uint64_t{1} << 48) - 1); }
  explicit operator bool() const noexcept { return word != 0; }
  bool operator==(const SegmentRef & other) const noexcept { return word == other.word; }
};
static_assert(sizeof(SegmentRef) == 8 && std::is_trivially_copyable_v<SegmentRef>);

/// Throws Error{corrupt} naming `what` unless the header is complete and has this layout.
void check_segment(
  const SegmentHeader & header, uint64_t magic, uint64_t mapped_bytes, const char * what);

}  // namespace manycore
