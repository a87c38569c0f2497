// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "platform/private_pages.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstring>

namespace manycore {

bool make_pages_private(const void * data, size_t size_bytes) noexcept {
  const auto page_bytes = static_cast<uintptr_t>(sysconf(_SC_PAGESIZE));
  const uintptr_t begin = reinterpret_cast<uintptr_t>(data) & ~(page_bytes - 1);
  const uintptr_t end =
    (reinterpret_cast<uintptr_t>(data) + size_bytes + page_bytes - 1) & ~(page_bytes - 1);
  const size_t bytes = end - begin;
  void * const pages = reinterpret_cast<void *>(begin);
  void * const copy =
    mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (copy == MAP_FAILED) {
    return false;
  }
  std::memcpy(copy, pages, bytes);
  if (mremap(copy, bytes, bytes, MREMAP_MAYMOVE | MREMAP_FIXED, pages) == MAP_FAILED) {
    munmap(copy, bytes);
    return false;
  }
  return true;
}

}  // namespace manycore
