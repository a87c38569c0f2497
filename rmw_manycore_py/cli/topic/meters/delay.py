# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Delay of a topic, computed and formatted as `ros2 topic delay` does."""

from __future__ import annotations

import statistics
from collections import deque
from dataclasses import dataclass


@dataclass(frozen=True)
class Delay:
    """Statistics over the window, in seconds from header stamp to callback."""

    average: float
    shortest: float
    longest: float
    deviation: float
    messages: int

    def __str__(self) -> str:
        return (
            f"average delay: {self.average:.3f}\n"
            f"\tmin: {self.shortest:.3f}s max: {self.longest:.3f}s "
            f"std dev: {self.deviation:.5f}s window: {self.messages}"
        )


class DelayMeter:
    """Keeps the delays of the last `window` messages."""

    def __init__(self, window: int) -> None:
        self._delays_s: deque[float] = deque(maxlen=window)

    def arrived(self, delay_s: float) -> None:
        """Record a message."""
        self._delays_s.append(delay_s)

    def delay(self) -> Delay | None:
        """Return the statistics, or None before the first message."""
        delays_s = self._delays_s
        if not delays_s:
            return None
        average_s = statistics.fmean(delays_s)
        deviation_s = statistics.pstdev(delays_s, average_s)
        return Delay(average_s, min(delays_s), max(delays_s), deviation_s, len(delays_s))
