// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "allocation_watch.hpp"

#include <algorithm>
#include <cstdlib>
#include <new>
#include <stdexcept>
#include <utility>

// Declared in <sanitizer/allocator_interface.h>, which not every g++ installs.
extern "C" int __sanitizer_install_malloc_and_free_hooks(
  void (*on_malloc)(const volatile void *, size_t), void (*on_free)(const volatile void *));

// Fast DDS allocates what a length claims, and refuses the message if that fails. Leak detection is
// off: the sanitizer cannot stop the threads of LTTng, which Fast DDS loads.
extern "C" [[gnu::visibility("default")]] const char * __asan_default_options() {
  return "allocator_may_return_null=1:max_allocation_size_mb=16:alloc_dealloc_mismatch=0:"
         "detect_leaks=0";
}

// The sanitizer's operator new aborts if there is no memory. The program exports this one, so all
// libraries use it.
void * operator new(size_t bytes) {
  if (void * const memory = std::malloc(bytes)) {
    return memory;
  }
  throw std::bad_alloc();
}

namespace allocation_watch {
namespace {

// of this thread only: the RMW has its own threads
thread_local size_t largest_bytes = 0;

void note(const volatile void *, size_t bytes) { largest_bytes = std::max(largest_bytes, bytes); }

void ignore(const volatile void *) {}

}  // namespace

void start() {
  if (__sanitizer_install_malloc_and_free_hooks(note, ignore) == 0) {
    throw std::runtime_error("the address sanitizer does not support hooks");
  }
}

size_t largest() noexcept { return std::exchange(largest_bytes, 0); }

}  // namespace allocation_watch
