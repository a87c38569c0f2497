# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The event queue: calls in the order of their times, and of their making where times are equal.

A heap of callbacks, without generators or processes: a transfer of 1 MB is some 32,000 events, and
a figure is hundreds of transfers.
"""

from __future__ import annotations

import heapq
from collections.abc import Callable
from typing import Any


class Events:
    """Simulated time in cycles, and the events that are due."""

    def __init__(self) -> None:
        self.now = 0.0
        self._made = 0
        self._due: list[tuple[float, int, Callable[..., None], tuple[Any, ...]]] = []

    def at(self, time: float, call: Callable[..., None], *arguments: Any) -> None:
        """Call a function at a time, which is not before now."""
        if time < self.now:
            raise ValueError(f"an event for cycle {time} at cycle {self.now}")
        self._made += 1
        heapq.heappush(self._due, (time, self._made, call, arguments))

    def run(self) -> None:
        """Handle events until none is left."""
        due = self._due
        while due:
            self.now, _, call, arguments = heapq.heappop(due)
            call(*arguments)
