# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Running time: like wall time, without the time in which the machine was too busy to run us.

A bound like "within a second" holds for our programs only while the machine schedules them. So a
thread counts the short sleeps that it completes: a process that was ready to run could have run
in that time, too.
"""

from __future__ import annotations

import os
import threading
import time
from bisect import bisect
from collections.abc import Callable
from typing import Any

TICK_S = 0.01
NS_PER_S = 1e9


class RunningTime:
    """A clock that stops while the machine does not schedule us on one of its CPUs.

    A CPU that a neighbour of the machine has taken delays only what is to run there.
    """

    def __init__(self) -> None:
        self._stopped = threading.Event()
        self._ticks_ns: dict[int, list[int]] = {cpu: [] for cpu in os.sched_getaffinity(0)}
        self._threads = [
            threading.Thread(target=self._tick, args=one, daemon=True)
            for one in self._ticks_ns.items()
        ]
        for thread in self._threads:
            thread.start()

    def _tick(self, cpu: int, ticks_ns: list[int]) -> None:
        os.sched_setaffinity(0, {cpu})  # of this thread
        while not self._stopped.wait(TICK_S):
            ticks_ns.append(time.monotonic_ns())

    def stop(self) -> None:
        self._stopped.set()
        for thread in self._threads:
            thread.join()

    def between_s(self, start_ns: int, end_ns: int) -> float:
        """Return how much of the time between two readings of the monotonic clock counts."""
        ticks = min(
            bisect(ticks_ns, end_ns) - bisect(ticks_ns, start_ns)
            for ticks_ns in self._ticks_ns.values()
        )
        return min(ticks * TICK_S, (end_ns - start_ns) / NS_PER_S)

    def since_s(self, start_ns: int) -> float:
        return self.between_s(start_ns, time.monotonic_ns())

    def wait_within(self, limit_s: float, condition: Callable[[], Any], what: str) -> None:
        """Poll a condition until it holds, for at most `limit_s` of running time."""
        start_ns = time.monotonic_ns()
        while not condition():
            if self.since_s(start_ns) > limit_s:
                raise AssertionError(f"not within {limit_s:g} s: {what}")
            time.sleep(TICK_S)
