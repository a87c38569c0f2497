# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Background load."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, closing, contextmanager

from rmw_manycore_py.bench.session import Process

_ENDLESS = "while True: pass"


@contextmanager
def busy(processes: int, cpus: Sequence[int], timeout_s: float) -> Iterator[None]:
    """Keep these CPUs busy with endless processes, for at most `timeout_s`."""
    command = [sys.executable, "-c", _ENDLESS]
    with ExitStack() as ending:
        for _ in range(processes):
            load = Process("load beside", command, dict(os.environ), cpus, timeout_s=timeout_s)
            ending.enter_context(closing(load))
        yield
