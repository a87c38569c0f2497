# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Worker processes, which are children of a member but no members themselves."""

from __future__ import annotations

import time
from collections.abc import Iterable, Sequence
from pathlib import Path

_PROGRAM = "manycore_ndt_wo"  # manycore_ndt_worker, truncated by the kernel
_PERIOD_S = 1.0
# Reading the children of a process with a dozen threads takes 0.1 ms: limits this work per period.
_MAX_IN_TURN = 16


class Workers:
    """Worker pids of processes; a replaced worker does not change the graph."""

    def __init__(self) -> None:
        self._pids: tuple[int, ...] = ()
        self._found: dict[int, tuple[int, ...]] = {}
        self._next = 0
        self._due_s = 0.0

    def of(self, pids: Sequence[int]) -> dict[int, tuple[int, ...]]:
        """Return the pids of the workers of each process that has any.

        If the set of processes has changed, checks all of them; then about once a second those that
        had workers, and the others in turn.
        """
        now_s = time.monotonic()
        if tuple(pids) != self._pids:
            self._pids = tuple(pids)
            self._found = _workers_of(self._pids)
        elif now_s >= self._due_s:
            self._found = _workers_of({*self._found, *self._in_turn()})
        else:
            return self._found
        self._due_s = now_s + _PERIOD_S
        return self._found

    def _in_turn(self) -> Sequence[int]:
        chosen = self._pids[self._next : self._next + _MAX_IN_TURN]
        self._next = self._next + _MAX_IN_TURN if len(chosen) == _MAX_IN_TURN else 0
        return chosen


def _workers_of(pids: Iterable[int]) -> dict[int, tuple[int, ...]]:
    found = {pid: tuple(_workers(pid)) for pid in pids}
    return {pid: workers for pid, workers in found.items() if workers}


def _workers(pid: int) -> list[int]:
    workers = []
    try:
        for task in Path(f"/proc/{pid}/task").iterdir():
            for child in map(int, (task / "children").read_text().split()):
                if Path(f"/proc/{child}/comm").read_text().strip() == _PROGRAM:
                    workers.append(child)
    except OSError:  # a thread has ended meanwhile
        pass
    return sorted(workers)
