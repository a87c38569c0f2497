# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""With whom a new process dies, settled before its first instruction."""

from __future__ import annotations

import ctypes
import os
import signal
from collections.abc import Callable

_PR_SET_PDEATHSIG = 1  # <linux/prctl.h>

# Looked up here, so that nothing has to be loaded between fork and exec.
_prctl = ctypes.CDLL(None, use_errno=True).prctl


def dies_with_this_process() -> Callable[[], None]:
    """Return a `preexec_fn`: the kernel kills the new process when this one dies, however it dies.

    For the kernel the parent is the thread that starts the process: call this in one that stays.
    Other threads may exist. Between fork and exec this function takes no lock that they could hold.
    """
    parent = os.getpid()

    def before_exec() -> None:
        _prctl(_PR_SET_PDEATHSIG, signal.SIGKILL, 0, 0, 0)
        if os.getppid() != parent:  # it died before the call
            os._exit(1)

    return before_exec
