# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The same alignment on several CPUs at once, independently: the actual capacity of the CPUs.

CPUs that share execution units, or a host with other guests, are slower together than one by one;
workers that share an alignment cannot exceed this speed-up.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack, contextmanager

from numpy.typing import ArrayLike

from rmw_manycore_py.ndt import MatcherOptions, SerialMatcher, VoxelMap

Align = Callable[[ArrayLike, ArrayLike], object]


def apart(count: int) -> str:
    """Return the name of the contender on this many CPUs."""
    return f"rmw_manycore alone on {f'each of {count} CPUs' if count > 1 else '1 CPU'}"


@contextmanager
def matchers_apart(
    options: MatcherOptions, voxel_map: VoxelMap, cpus: Sequence[int]
) -> Iterator[Align]:
    """Yield a function that aligns a scan on each CPU and returns when the last has finished."""
    with ExitStack() as stack:
        threads = []
        for cpu in cpus:
            matcher = SerialMatcher(options)
            matcher.set_map(voxel_map)
            thread = ThreadPoolExecutor(1, initializer=_pin, initargs=(cpu,))
            threads.append((stack.enter_context(thread), matcher))

        def align(scan: ArrayLike, guess: ArrayLike) -> None:
            for done in [thread.submit(matcher.align, scan, guess) for thread, matcher in threads]:
                done.result()

        yield align


def _pin(cpu: int) -> None:
    os.sched_setaffinity(0, {cpu})
