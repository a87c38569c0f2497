// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sched.h>

namespace manycore {

/// Between two looks at a word that another CPU will write.
inline void pause_cpu() noexcept {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#elif defined(__aarch64__)
  asm volatile("yield");
#endif
}

/// Lets a thread that is ready on this CPU run first.
inline void yield_cpu() noexcept { sched_yield(); }

/// The only host CPU this thread may use, or -1 when there are several.
inline int only_cpu() noexcept {
  cpu_set_t cpus;
  if (sched_getaffinity(0, sizeof cpus, &cpus) != 0 || CPU_COUNT(&cpus) != 1) {
    return -1;
  }
  int cpu = 0;
  while (!CPU_ISSET(static_cast<size_t>(cpu), &cpus)) {
    ++cpu;
  }
  return cpu;
}

}  // namespace manycore
