// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sched.h>

namespace manycore {

/// Spin-wait hint, for use between two loads of a word that another CPU writes.
inline void pause_cpu() noexcept {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#elif defined(__aarch64__)
  asm volatile("yield");
#endif
}

/// Lets another thread that is runnable on this CPU run first.
inline void yield_cpu() noexcept { sched_yield(); }

/// The only host CPU in this thread's affinity mask, or -1 if there are several.
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
