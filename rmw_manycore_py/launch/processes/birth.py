# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Where a new process runs, settled before its first instruction."""

from __future__ import annotations

import os
from collections.abc import Collection, Iterator
from contextlib import contextmanager


@contextmanager
def pinned_to(host_cpus: Collection[int]) -> Iterator[None]:
    """Pin the calling thread while it starts a process, which inherits the CPUs from it.

    So a node never runs anywhere else, and a CPU that does not exist is an OSError here. Without
    CPUs nothing changes.
    """
    before = os.sched_getaffinity(0)
    try:
        os.sched_setaffinity(0, host_cpus or before)
    except OSError as error:
        named = " ".join(map(str, host_cpus))
        raise OSError(error.errno, f"host CPU {named} is none this process may use") from error
    try:
        yield
    finally:
        os.sched_setaffinity(0, before)
