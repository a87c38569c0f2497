# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Single-key input from the terminal."""

from __future__ import annotations

import os
import sys
import termios
import tty
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def single_keys(*, wanted: bool = True) -> Iterator[int | None]:
    """Yield a descriptor of unbuffered, unechoed key input; Ctrl-C still raises SIGINT.

    Yields None without a terminal and for background jobs: the kernel stops a background job that
    changes the terminal's settings.
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
        if _is_ours(descriptor):  # in the background, the shell has set its own mode
            termios.tcsetattr(descriptor, termios.TCSADRAIN, before)


def _is_ours(descriptor: int) -> bool:
    try:
        return os.isatty(descriptor) and os.tcgetpgrp(descriptor) == os.getpgrp()
    except OSError:
        return False
