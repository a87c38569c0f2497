# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Time as a process on this machine gets it: what the machine is too busy for does not count.

"Within a second" is a promise about our programs. On a machine that lets nobody run for a second it
cannot be kept, and says nothing about them. So a thread counts the short sleeps that it gets done:
a process that was ready to run could have run then, too.
"""

from __future__ import annotations

import threading
import time
from bisect import bisect
from collections.abc import Callable
from typing import Any

TICK_S = 0.01
NS_PER_S = 1e9


class RunningTime:
    """A clock that stands still while the machine does."""

    def __init__(self) -> None:
        self._ticks_ns: list[int] = []
        self._stopped = threading.Event()
        self._thread = threading.Thread(target=self._tick, daemon=True)
        self._thread.start()

    def _tick(self) -> None:
        while not self._stopped.wait(TICK_S):
            self._ticks_ns.append(time.monotonic_ns())

    def stop(self) -> None:
        self._stopped.set()
        self._thread.join()

    def between_s(self, start_ns: int, end_ns: int) -> float:
        """Return how much of the time between two readings of the monotonic clock counts."""
        ticks = bisect(self._ticks_ns, end_ns) - bisect(self._ticks_ns, start_ns)
        return min(ticks * TICK_S, (end_ns - start_ns) / NS_PER_S)

    def since_s(self, start_ns: int) -> float:
        return self.between_s(start_ns, time.monotonic_ns())

    def wait_within(self, limit_s: float, condition: Callable[[], Any], what: str) -> None:
        """Look at a condition until it holds, at most for `limit_s` that count."""
        start_ns = time.monotonic_ns()
        while not condition():
            if self.since_s(start_ns) > limit_s:
                raise AssertionError(f"not within {limit_s:g} s: {what}")
            time.sleep(TICK_S)
