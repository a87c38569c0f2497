# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Samples of a profile's distributions, drawn in blocks."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from rmw_manycore_py.profile.model import Distribution

Floats = NDArray[np.float64]
_BLOCK = 256


class Quantiles:
    """Inverse of a distribution function, linear between the quantiles of a profile."""

    def __init__(self, shares: Floats, distribution: Distribution) -> None:
        self._shares = shares
        self._values = np.array(distribution.quantiles)

    @property
    def median(self) -> float:
        """Return the median."""
        return float(np.interp(0.5, self._shares, self._values))

    @property
    def mean(self) -> float:
        """Return the mean of what `at` draws, which the last quantiles of a burst miss."""
        values, shares = self._values, self._shares
        return float(np.sum((values[1:] + values[:-1]) / 2 * np.diff(shares)))

    def at(self, share: Floats) -> Floats:
        """Return the quantiles at these shares."""
        found: Floats = np.interp(share, self._shares, self._values)
        return found


class Blocks:
    """Hands out values one by one, and has a function make the next block when they are used up."""

    def __init__(self, make: Callable[[int], Floats]) -> None:
        self._make = make
        self._values: list[float] = []

    def next(self) -> float:
        """Return the next value."""
        if not self._values:
            self._values = self._make(_BLOCK).tolist()
        return self._values.pop()


def uniform(random: np.random.Generator) -> Blocks:
    """Return values from 0 to 1."""
    return Blocks(lambda count: random.random(count))


def samples(random: np.random.Generator, quantiles: Quantiles) -> Blocks:
    """Return samples of a distribution."""
    return Blocks(lambda count: quantiles.at(random.random(count)))
