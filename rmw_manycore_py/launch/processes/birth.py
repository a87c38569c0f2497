# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Where a new process runs and with whom it dies, settled before its first instruction."""

from __future__ import annotations

import ctypes
import os
import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager

_PR_SET_PDEATHSIG = 1  # <linux/prctl.h>

# Looked up here, so that nothing has to be loaded between fork and exec.
_prctl = ctypes.CDLL(None, use_errno=True).prctl


@contextmanager
def pinned_to(host_cpu: int) -> Iterator[None]:
    """Pin the calling thread while it starts a process, which inherits the CPU from it.

    So a node never runs anywhere else, and a CPU that does not exist is an OSError here.
    """
    before = os.sched_getaffinity(0)
    try:
        os.sched_setaffinity(0, {host_cpu})
    except OSError as error:
        raise OSError(error.errno, f"host CPU {host_cpu} is none this process may use") from error
    try:
        yield
    finally:
        os.sched_setaffinity(0, before)


def dies_with_this_process() -> Callable[[], None]:
    """Return a `preexec_fn`: the kernel kills the new process when this one dies, however it dies.

    Only for a process with one thread: between fork and exec nothing else can hold a lock then.
    """
    parent = os.getpid()

    def before_exec() -> None:
        _prctl(_PR_SET_PDEATHSIG, signal.SIGKILL, 0, 0, 0)
        if os.getppid() != parent:  # it died before the call
            os._exit(1)

    return before_exec
