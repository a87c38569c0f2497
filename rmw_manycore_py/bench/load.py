# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Other programs, beside which something is measured."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, closing, contextmanager

from rmw_manycore_py.bench.session import Process

_ENDLESS = "while True: pass"


@contextmanager
def busy(processes: int, cpus: Sequence[int], patience_s: float) -> Iterator[None]:
    """Have so many processes take all the time they get on these CPUs, so long at most."""
    command = [sys.executable, "-c", _ENDLESS]
    with ExitStack() as ending:
        for _ in range(processes):
            load = Process("load beside", command, dict(os.environ), cpus, patience_s=patience_s)
            ending.enter_context(closing(load))
        yield
