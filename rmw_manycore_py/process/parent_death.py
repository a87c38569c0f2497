# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Ties the life of a new process to that of its parent."""

from __future__ import annotations

import ctypes
import os
import signal
from collections.abc import Callable

_PR_SET_PDEATHSIG = 1  # <linux/prctl.h>

# Resolved at import, so that nothing is loaded between fork and exec.
_prctl = ctypes.CDLL(None, use_errno=True).prctl


def dies_with_this_process() -> Callable[[], None]:
    """Return a `preexec_fn`: the kernel kills the new process when this one dies.

    The kernel takes the creating thread for the parent, so call this in a long-lived thread. Safe
    with other threads: it takes no lock between fork and exec.
    """
    parent = os.getpid()

    def before_exec() -> None:
        _prctl(_PR_SET_PDEATHSIG, signal.SIGKILL, 0, 0, 0)
        if os.getppid() != parent:  # the parent died before the call
            os._exit(1)

    return before_exec
