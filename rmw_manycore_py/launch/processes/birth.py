# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Pinning of a new process before its first instruction."""

from __future__ import annotations

import os
from collections.abc import Collection, Iterator
from contextlib import contextmanager


@contextmanager
def pinned_to(host_cpus: Collection[int]) -> Iterator[None]:
    """Pin the calling thread while it starts a process, which inherits the affinity mask.

    A node thus never runs on another CPU. No-op without `host_cpus`.

    :raises OSError: for a CPU that does not exist or is not allowed.
    """
    before = os.sched_getaffinity(0)
    try:
        os.sched_setaffinity(0, host_cpus or before)
    except OSError as error:
        named = " ".join(map(str, host_cpus))
        raise OSError(
            error.errno, f"host CPU {named} is not in this process's affinity mask"
        ) from error
    try:
        yield
    finally:
        os.sched_setaffinity(0, before)
