# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Which products are computed: sizes, places, threads, and how results are named."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from rmw_manycore_py.bench.summary import Curve
from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError

Place = Literal["IO DDR", "IO SMEM", "CC SMEM", "off-load to four CC"]
IO_DDR: Place = "IO DDR"
IO_SMEM: Place = "IO SMEM"
CC_SMEM: Place = "CC SMEM"
OFFLOAD: Place = "off-load to four CC"
# Three float32 matrices of 314 KB, and of 640 KB.
SMALL, LARGE = 280, 400
RUNS = 200  # of a round; the default is five rounds
LOST = "C collected from four CC"
MAX_N = 1024
_THREADS: dict[Place, tuple[int, ...]] = {
    IO_DDR: (1, 2, 3, 4),
    IO_SMEM: (1, 2, 3, 4),
    CC_SMEM: (1, 2, 4, 8, 16),
    OFFLOAD: (1, 2, 4, 8, 16),
}


@dataclass(frozen=True)
class Case:
    """One way to multiply two n x n matrices; off-loaded, `threads` are those of each cluster."""

    n: int
    place: Place
    is_cached: bool
    threads: int

    @property
    def question(self) -> str:
        """How the report names the figure it belongs to."""
        how = "off-load" if self.place == OFFLOAD else "cached" if self.is_cached else "uncached"
        return f"{how}, {self.n} x {self.n}"

    @property
    def name(self) -> str:
        """How results name it."""
        return f"{self.place}, {self.threads} thread{'s' if self.threads > 1 else ''}"

    @property
    def curve(self) -> Curve:
        """Where it lies in the common plot."""
        return Curve(self.place, self.threads, "threads")


def cases(sizes: Sequence[int]) -> list[Case]:
    """Return the cases of figures 4.9 to 4.12; the larger matrices are for off-loading only.

    :raises ManycoreError: for a size that is no matrix, or too large a one.
    """
    for n in sizes:
        if not 2 <= n <= MAX_N:
            message = f"--n {n}: expected 2 to {MAX_N}, rows of a square matrix"
            raise ManycoreError(message, EXIT_BAD_INPUT)
    ordered = sorted(set(sizes))
    found = []
    for n in ordered:
        in_one_place = (IO_DDR, IO_SMEM, CC_SMEM) if n == ordered[0] else ()
        found += [_each(n, place, True) for place in in_one_place or (IO_DDR,)]
        found += [_each(n, place, False) for place in in_one_place]
        found.append(_each(n, OFFLOAD, False))
    return [case for some in found for case in some]


def threads_of(place: Place) -> tuple[int, ...]:
    """Return the numbers of threads that a place is measured with."""
    return _THREADS[place]


def _each(n: int, place: Place, is_cached: bool) -> list[Case]:
    return [Case(n, place, is_cached, threads) for threads in threads_of(place)]
