# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Rate of a topic, from the arrival times of its messages."""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass


@dataclass(frozen=True)
class Rate:
    """Statistics of the intervals between messages, in seconds."""

    rate_hz: float
    min_s: float
    max_s: float
    std_dev_s: float
    window: int

    def __str__(self) -> str:
        return (
            f"average rate: {self.rate_hz:.3f}\n\tmin: {self.min_s:.3f}s max: {self.max_s:.3f}s "
            f"std dev: {self.std_dev_s:.5f}s window: {self.window}"
        )


class RateMeter:
    """Keeps the last `window` intervals."""

    def __init__(self, window: int) -> None:
        self._intervals_s: deque[float] = deque(maxlen=window)
        self._last_s: float | None = None

    def arrived(self, now_s: float) -> None:
        """Record a message."""
        if self._last_s is not None:
            self._intervals_s.append(now_s - self._last_s)
        self._last_s = now_s

    def rate(self) -> Rate | None:
        """Return the statistics, or None before the second message."""
        count = len(self._intervals_s)
        total_s = sum(self._intervals_s)
        if not count or not total_s:
            return None
        mean_s = total_s / count
        variance = sum((interval - mean_s) ** 2 for interval in self._intervals_s) / count
        shortest_s, longest_s = min(self._intervals_s), max(self._intervals_s)
        return Rate(1 / mean_s, shortest_s, longest_s, math.sqrt(variance), count)
