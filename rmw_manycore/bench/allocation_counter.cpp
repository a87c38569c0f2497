// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "bench/allocation_counter.hpp"

#include <atomic>
#include <cerrno>
#include <cstddef>

// The C library's allocation functions, under names that are not interposed.
extern "C" {
// NOLINTBEGIN(readability-identifier-naming)
void * __libc_malloc(size_t size);
void * __libc_calloc(size_t count, size_t size);
void * __libc_realloc(void * memory, size_t size);
void * __libc_memalign(size_t alignment, size_t size);
// NOLINTEND(readability-identifier-naming)
}

namespace {

std::atomic<uint64_t> count{0};

void note() noexcept { count.fetch_add(1, std::memory_order_relaxed); }

}  // namespace

uint64_t manycore::bench::allocations() noexcept { return count.load(std::memory_order_relaxed); }

// Definitions in an executable take precedence over those of libraries. Memory still comes from the
// C library, so free() needs no replacement.
#define BENCH_INTERPOSE extern "C" __attribute__((visibility("default")))

BENCH_INTERPOSE void * malloc(size_t size) noexcept {
  note();
  return __libc_malloc(size);
}

BENCH_INTERPOSE void * calloc(size_t number, size_t size) noexcept {
  note();
  return __libc_calloc(number, size);
}

BENCH_INTERPOSE void * realloc(void * memory, size_t size) noexcept {
  note();
  return __libc_realloc(memory, size);
}

BENCH_INTERPOSE void * aligned_alloc(size_t alignment, size_t size) noexcept {
  note();
  return __libc_memalign(alignment, size);
}

BENCH_INTERPOSE int posix_memalign(void ** memory, size_t alignment, size_t size) noexcept {
  note();
  *memory = __libc_memalign(alignment, size);
  return *memory == nullptr ? ENOMEM : 0;
}
