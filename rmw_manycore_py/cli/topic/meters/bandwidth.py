# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Bandwidth of a topic, computed and formatted as `ros2 topic bw` does."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

_UNITS = ((1_000_000, "MB"), (1_000, "KB"))


@dataclass(frozen=True)
class Bandwidth:
    """Statistics over the window, sizes in bytes."""

    bytes_per_s: float
    messages: int
    mean: float
    shortest: int
    longest: int

    def __str__(self) -> str:
        rate, mean, shortest, longest = (
            self._text(size) for size in (self.bytes_per_s, self.mean, self.shortest, self.longest)
        )
        return (
            f"{rate}/s from {self.messages} messages\n"
            f"\tMessage size mean: {mean} min: {shortest} max: {longest}"
        )

    def _text(self, size: float) -> str:
        """Format a size in the unit of the rate, so that all are comparable."""
        for factor, unit in _UNITS:
            if self.bytes_per_s >= factor:
                return f"{size / factor:.2f} {unit}"
        return f"{size:.0f} B"


class BandwidthMeter:
    """Keeps the times and sizes of the last `window` messages."""

    def __init__(self, window: int) -> None:
        self._messages: deque[tuple[float, int]] = deque(maxlen=window)

    def arrived(self, now_s: float, size: int) -> None:
        """Record a message of `size` bytes."""
        self._messages.append((now_s, size))

    def bandwidth(self, now_s: float) -> Bandwidth | None:
        """Return the statistics, or None before the second message."""
        if len(self._messages) < 2 or now_s <= self._messages[0][0]:
            return None
        sizes = [size for _, size in self._messages]
        total = sum(sizes)
        duration_s = now_s - self._messages[0][0]
        count = len(sizes)
        return Bandwidth(total / duration_s, count, total / count, min(sizes), max(sizes))
