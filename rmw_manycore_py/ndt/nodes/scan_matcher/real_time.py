# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Real-time scheduling of a matcher's threads and workers."""

from __future__ import annotations

import os
import resource
import threading
from collections.abc import Iterable

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError

PARAMETER = "realtime_priority"


def schedule_in_real_time(priority: int, pids: Iterable[int]) -> None:
    """Set SCHED_FIFO for the calling thread and the main threads of processes.

    Threads and processes they start later inherit it, so replaced workers have it, too.

    :param priority: 1 to 99; 0 is a no-op.
    :raises ManycoreError: if limits forbid it; the calling thread is then unchanged.
    """
    if priority == 0:
        return
    try:
        for thread in (*pids, threading.get_native_id()):
            os.sched_setscheduler(thread, os.SCHED_FIFO, os.sched_param(priority))
    except PermissionError as error:
        raise ManycoreError(_how_to_allow(priority), EXIT_BAD_INPUT) from error


def _how_to_allow(priority: int) -> str:
    limit, _ = resource.getrlimit(resource.RLIMIT_RTPRIO)
    return (
        f"parameter {PARAMETER}: expected at most {limit}, this process's limit for real-time "
        f"priorities (ulimit -r), found {priority}: raise it in /etc/security/limits.conf ('USER - "
        f"rtprio {priority}'), give the capability CAP_SYS_NICE, or leave the parameter at 0"
    )
