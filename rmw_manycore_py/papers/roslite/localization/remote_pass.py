# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A pass whose sums come in parts from other nodes."""

from __future__ import annotations

import queue
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.ndt.geometry.arrays import Matrix
from rmw_manycore_py.process.steady import steady_s


@dataclass(frozen=True)
class Part:
    """Sums (37,) of one of the derivatives, for a pass of a scan."""

    scan_ns: int
    pass_number: int
    part: int
    sums: NDArray[np.float64]


class RemotePass:
    """Asks for passes of one scan after the other, and waits for all their parts.

    :param ask: called with stamp, number and pose (4, 4) of a pass.
    :param parts: number of derivatives.
    :param timeout_s: how long a pass may take.
    """

    def __init__(
        self, ask: Callable[[int, int, Matrix], None], parts: int, timeout_s: float
    ) -> None:
        self._ask = ask
        self._parts = parts
        self._timeout_s = timeout_s
        self._arrived: queue.SimpleQueue[Part] = queue.SimpleQueue()
        self._scan_ns = 0
        self._number = 0  # of the pass, in the current scan

    def begin(self, scan_ns: int) -> None:
        """Begin with a scan."""
        self._scan_ns, self._number = scan_ns, 0

    def arrived(self, part: Part) -> None:
        """Take a part, from another thread; those of earlier passes are ignored."""
        self._arrived.put(part)

    def __call__(self, pose: Matrix) -> NDArray[np.float64]:
        """Return the sums at a pose; raises ManycoreError if a part does not come."""
        self._number += 1
        self._ask(self._scan_ns, self._number, pose)
        found: dict[int, NDArray[np.float64]] = {}
        deadline_s = steady_s() + self._timeout_s
        while len(found) < self._parts:
            try:
                part = self._arrived.get(timeout=max(deadline_s - steady_s(), 0.0))
            except queue.Empty:
                if steady_s() < deadline_s:  # virtual time has not passed
                    continue
                raise ManycoreError(
                    f"pass {self._number}: {len(found)} of {self._parts} derivatives answered in "
                    f"{self._timeout_s:g} s; the scan is left out"
                ) from None
            if (part.scan_ns, part.pass_number) == (self._scan_ns, self._number):
                found[part.part] = part.sums
        # Always in the same order, whichever part came first.
        total: NDArray[np.float64] = np.sum([found[part] for part in sorted(found)], axis=0)
        return total
