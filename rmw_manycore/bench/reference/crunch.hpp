// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "platform/clock.hpp"

namespace manycore::bench::reference {

inline int64_t thread_cpu_ns() { return clock_ns(CLOCK_THREAD_CPUTIME_ID); }

inline bool is_prime(int64_t number) {
  for (int64_t divisor = 2; divisor < number; ++divisor) {
    if (number % divisor == 0) {
      return false;
    }
  }
  return true;
}

/// Counts primes until this thread has used `cpu_ns` of CPU time: the same work on all machines,
/// where upstream requires a calibrated limit.
inline int64_t crunch(int64_t cpu_ns) {
  if (cpu_ns <= 0) {
    return 0;
  }
  int64_t primes = 0;
  const int64_t end_ns = thread_cpu_ns() + cpu_ns;
  for (int64_t number = 2; thread_cpu_ns() < end_ns; ++number) {
    primes += is_prime(number) ? 1 : 0;
  }
  return primes;
}

}  // namespace manycore::bench::reference
