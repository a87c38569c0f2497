# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""CPU time of a process and its descendants."""

from __future__ import annotations

import os
from pathlib import Path

TICKS_PER_S = os.sysconf("SC_CLK_TCK")
USER, SYSTEM = 11, 12  # fields of /proc/PID/stat after the program name


def tree_cpu_s(pid: int | None = None) -> float:
    """Return user + system time of a process and its living descendants, in seconds."""
    own = os.getpid() if pid is None else pid
    try:
        tasks = list(Path(f"/proc/{own}/task").iterdir())
        children = [child for task in tasks for child in (task / "children").read_text().split()]
    except OSError:  # it has ended meanwhile
        return 0.0
    return process_cpu_s(own) + sum(tree_cpu_s(int(child)) for child in children)


def process_cpu_s(pid: int) -> float:
    """Return user + system time of a process in seconds; 0 after its end."""
    try:
        stat = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return 0.0
    return (int(stat[USER]) + int(stat[SYSTEM])) / TICKS_PER_S
