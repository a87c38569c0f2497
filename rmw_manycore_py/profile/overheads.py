# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""CPU time that no callback accounts for: of executors around them, and of receive threads."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rmw_manycore_py.profile.turns import Turn
from rmw_manycore_py.trace.events import Kind, Process, Row, Trace
from rmw_manycore_py.trace.flows import merged


@dataclass
class Rest:
    """CPU time of a process outside of its callbacks and of what leads to them."""

    cpu_ns: float = 0.0
    callbacks: int = 0

    def add(self, rows: Sequence[Row], turns: Sequence[Turn]) -> None:
        """Count a thread, which has read its CPU time where it waits."""
        waits = (Kind.WAIT_BEGIN, Kind.WAIT_END)
        readings = [row for row in rows if row[-1] in waits and row[1]]
        if len(readings) < 2:
            return
        begin_ns, end_ns = readings[0][0], readings[-1][0]
        counted = [
            one
            for one in turns
            if one.cpu_ns is not None and one.is_callback and begin_ns <= one.begin_ns < end_ns
        ]
        self.cpu_ns += readings[-1][1] - readings[0][1]
        self.cpu_ns -= sum((one.cpu_ns or 0.0) + (one.dispatch_ns or 0) for one in counted)
        self.callbacks += len(counted)

    @property
    def mean_ns(self) -> float | None:
        """CPU time for each callback; None if unknown."""
        return max(self.cpu_ns / self.callbacks, 0.0) if self.callbacks else None


def process_cpu_ns(process: Process, begin_ns: int, end_ns: int) -> float:
    """Return the CPU time of a process between two times, by samples of the time used so far."""
    samples = merged([(process, thread) for thread in process.threads], (Kind.CPU,))
    if not len(samples):
        return 0.0
    used = np.interp([begin_ns, end_ns], samples["time_ns"], samples["value"])
    return float(used[1] - used[0])


def receive_ns(trace: Trace, begin_ns: int, end_ns: int) -> float | None:
    """Return the CPU time of receive threads for each eMCOS message; None without messages."""
    received = 0
    for _, thread in trace.threads():
        times_ns = thread.events["time_ns"][thread.events["kind"] == Kind.RECEIVE]
        received += int(((times_ns >= begin_ns) & (times_ns <= end_ns)).sum())
    threads = [one for one in trace.processes if one.is_receive_thread]
    used_ns = sum(process_cpu_ns(one, begin_ns, end_ns) for one in threads)
    return used_ns / received if received else None
