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


class PassesEndedError(Exception):
    """The node ends while a pass is under way."""


class RemotePass:
    """Asks for passes of one scan after the other, and waits for all their parts.

    It waits without a timeout, which would be one of the wall clock: a timer of the node looks
    whether a pass is late.

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
        self._arrived: queue.SimpleQueue[Part | None] = queue.SimpleQueue()
        self._has_ended = False
        self._begun_s: float | None = None  # a pass under way
        self._scan_ns = 0
        self._number = 0  # of the pass, in the current scan

    def begin(self, scan_ns: int) -> None:
        """Begin with a scan."""
        self._scan_ns, self._number = scan_ns, 0

    def arrived(self, part: Part) -> None:
        """Take a part, from another thread; those of earlier passes are ignored."""
        self._arrived.put(part)

    def look(self) -> None:
        """End a pass that is late, from another thread."""
        if self._is_late():
            self._arrived.put(None)

    def close(self) -> None:
        """End the passes, from another thread."""
        self._has_ended = True
        self._arrived.put(None)

    def _is_late(self) -> bool:
        begun_s = self._begun_s
        return begun_s is not None and steady_s() >= begun_s + self._timeout_s

    def __call__(self, pose: Matrix) -> NDArray[np.float64]:
        """Return the sums at a pose.

        :raises ManycoreError: if a part does not come in time.
        :raises PassesEndedError: if the passes were closed.
        """
        self._number += 1
        self._begun_s = steady_s()
        self._ask(self._scan_ns, self._number, pose)
        try:
            found = self._found()
        finally:
            self._begun_s = None
        # Always in the same order, whichever part came first.
        total: NDArray[np.float64] = np.sum([found[part] for part in sorted(found)], axis=0)
        return total

    def _found(self) -> dict[int, NDArray[np.float64]]:
        found: dict[int, NDArray[np.float64]] = {}
        while len(found) < self._parts:
            part = self._arrived.get()
            if self._has_ended:
                raise PassesEndedError
            if part is None:
                if self._is_late():  # this pass, not an earlier one
                    raise ManycoreError(
                        f"pass {self._number}: {len(found)} of {self._parts} derivatives answered "
                        f"in {self._timeout_s:g} s; the scan is left out"
                    )
            elif (part.scan_ns, part.pass_number) == (self._scan_ns, self._number):
                found[part.part] = part.sums
        return found
