# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Worker processes: no members of the platform, but children of one."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

_PROGRAM = "manycore_ndt_wo"  # as the kernel cuts the name of manycore_ndt_worker


def workers_of(pids: Iterable[int]) -> dict[int, tuple[int, ...]]:
    """Return the pids of the workers of each process that has some."""
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
