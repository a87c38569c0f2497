// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <stdexcept>

#if defined(__x86_64__)
#include <emmintrin.h>
#endif

namespace manycore::bench {

constexpr size_t cache_line_bytes = 64;

/// Evicts a range from all caches of all CPUs, so that the next access goes to DRAM.
inline void flush(const void * data, size_t size_bytes) {
#if defined(__x86_64__)
  const auto * const bytes = static_cast<const std::byte *>(data);
  for (size_t offset = 0; offset < size_bytes; offset += cache_line_bytes) {
    _mm_clflush(bytes + offset);
  }
  _mm_clflush(bytes + size_bytes - 1);
  _mm_mfence();
#else
  static_cast<void>(data);
  static_cast<void>(size_bytes);
  throw std::runtime_error("evicting caches from user space needs an x86-64 CPU");
#endif
}

}  // namespace manycore::bench
