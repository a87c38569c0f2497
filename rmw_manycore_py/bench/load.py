# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Background load."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, closing, contextmanager

from rmw_manycore_py.bench.session import Process

_ENDLESS = "while True: pass"
_WHEN_IDLE = f"import os\nos.sched_setscheduler(0, os.SCHED_IDLE, os.sched_param(0))\n{_ENDLESS}"


@contextmanager
def busy(processes: int, cpus: Sequence[int], timeout_s: float) -> Iterator[None]:
    """Keep these CPUs busy with endless processes, for at most `timeout_s`."""
    with _running("load beside", _ENDLESS, [cpus] * processes, timeout_s):
        yield


@contextmanager
def awake(cpus: Sequence[int], timeout_s: float) -> Iterator[None]:
    """Keep these CPUs from sleeping, by a process on each that gives way to any other.

    To wake a CPU that sleeps takes as long as publishing a small message, or twice as long.
    """
    with _running("what keeps a CPU awake", _WHEN_IDLE, [[cpu] for cpu in cpus], timeout_s):
        yield


@contextmanager
def _running(
    name: str, code: str, places: Sequence[Sequence[int]], timeout_s: float
) -> Iterator[None]:
    command = [sys.executable, "-c", code]
    with ExitStack() as ending:
        for cpus in places:
            load = Process(name, command, dict(os.environ), cpus, timeout_s=timeout_s)
            ending.enter_context(closing(load))
        yield
