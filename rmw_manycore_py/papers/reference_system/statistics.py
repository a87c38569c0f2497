# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Running statistics, in the text format of the reference system's reports."""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass
class Statistic:
    """Minimum, maximum, mean and deviation of the values so far (Welford)."""

    suffix: str = ""
    count: int = 0
    current: float = 0.0
    low: float = math.inf
    high: float = -math.inf
    average: float = 0.0
    _squares: float = 0.0

    def add(self, value: float) -> None:
        """Add a value."""
        self.count += 1
        self.current = value
        self.low = min(self.low, value)
        self.high = max(self.high, value)
        delta = value - self.average
        self.average += delta / self.count
        self._squares += delta * (value - self.average)

    @property
    def deviation(self) -> float:
        """Return the sample standard deviation; NaN for a single value."""
        return math.sqrt(self._squares / (self.count - 1)) if self.count > 1 else math.nan

    def __str__(self) -> str:
        unit = self.suffix
        return (
            f"{self.current:g}{unit} [min={self.low:g}{unit}, max={self.high:g}{unit}, "
            f"average={self.average:g}{unit}, deviation={self.deviation:g}{unit}]"
        )
