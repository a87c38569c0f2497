# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Worker processes: no members of the platform, but children of one."""

from __future__ import annotations

import time
from collections.abc import Iterable, Sequence
from pathlib import Path

_PROGRAM = "manycore_ndt_wo"  # as the kernel cuts the name of manycore_ndt_worker
_PERIOD_S = 1.0
# The children of a process with a dozen threads take 0.1 ms to read: of a crowd, so many a period.
_MAX_IN_TURN = 16


class Workers:
    """The workers of some processes: a worker that is replaced changes nothing in the graph."""

    def __init__(self) -> None:
        self._pids: tuple[int, ...] = ()
        self._found: dict[int, tuple[int, ...]] = {}
        self._next = 0
        self._due_s = 0.0

    def of(self, pids: Sequence[int]) -> dict[int, tuple[int, ...]]:
        """Return the pids of the workers of each process that has some.

        All processes are looked at when they are others than before; from then on about each
        second those that had workers, and the others in turn.
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
    except OSError:  # one of them has ended meanwhile
        pass
    return sorted(workers)
