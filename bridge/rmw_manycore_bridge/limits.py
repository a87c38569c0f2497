# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Rate and size limits of a route, and gaps in what it receives."""

from __future__ import annotations

import time
from collections.abc import Mapping

from rmw_manycore_bridge.counters import Row
from rmw_manycore_py.routes.route import Route

_NS_PER_S = 1_000_000_000


class Limits:
    """Rate and size limits of a route."""

    def __init__(self, route: Route) -> None:
        self._max_size = route.max_size
        self._period_ns = int(_NS_PER_S / route.max_hz) if route.max_hz else 0
        self._next_ns = 0

    def refusal(self, size: int) -> str | None:
        """Return the counter name of the limit that a message exceeds; None if it may pass."""
        if self._max_size is not None and size > self._max_size:
            return "too_large"
        if self._period_ns:
            now_ns = time.monotonic_ns()
            if now_ns < self._next_ns:
                return "too_fast"
            # Keeps the mean rate although messages arrive slightly early at times.
            self._next_ns = max(self._next_ns + self._period_ns, now_ns)
        return None


class Gaps:
    """Counts messages missing from each publisher's sequence numbers."""

    def __init__(self, row: Row) -> None:
        self._row = row
        self._last: dict[bytes, int] = {}

    def begin_after(self, last: Mapping[bytes, int]) -> None:
        """Continue after the numbers at which another lane stopped."""
        self._last.update(last)

    def note(self, publisher: bytes, number: int) -> None:
        """Count the gap before a message; sequence numbers of a publisher increase by one."""
        last = self._last.get(publisher)
        if last is None or number > last:
            self._last[publisher] = number
            if last is not None and number > last + 1:
                self._row.add("lost", number - last - 1)
