# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A terminal whose keys a verb listens to."""

from __future__ import annotations

import os
import sys
import termios
import tty
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def single_keys(*, wanted: bool = True) -> Iterator[int | None]:
    """Yield the descriptor that keys come from, one by one and unseen; Ctrl-C stays what it is.

    It is None without a terminal, and for a job in the background: the kernel stops one that
    changes its terminal's settings.
    """
    descriptor = sys.stdin.fileno() if sys.stdin is not None else -1
    if not wanted or not _is_ours(descriptor):
        yield None
        return
    before = termios.tcgetattr(descriptor)
    tty.setcbreak(descriptor, termios.TCSADRAIN)
    try:
        yield descriptor
    finally:
        if _is_ours(descriptor):  # else it went to the background, and the shell has set its own
            termios.tcsetattr(descriptor, termios.TCSADRAIN, before)


def _is_ours(descriptor: int) -> bool:
    try:
        return os.isatty(descriptor) and os.tcgetpgrp(descriptor) == os.getpgrp()
    except OSError:
        return False
