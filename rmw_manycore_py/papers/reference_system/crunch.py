# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Simulated work of a callback."""

import time

NS_PER_MS = 1e6


def crunch(cpu_ms: float) -> int:
    """Count primes until this thread has used `cpu_ms` of CPU time; return their number.

    Upstream counts the primes below a limit that has to be calibrated per machine; CPU time is the
    same amount of work everywhere, also in C++.
    """
    if cpu_ms <= 0:
        return 0
    end_ns = time.thread_time_ns() + int(cpu_ms * NS_PER_MS)
    primes, number = 0, 2
    while time.thread_time_ns() < end_ns:
        primes += all(number % divisor for divisor in range(2, number))
        number += 1
    return primes
