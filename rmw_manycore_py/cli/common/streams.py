# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The standard streams of a command."""

from __future__ import annotations

import os
import select
import sys

_OUTPUTS = (1, 2)


def open_closed_streams() -> None:
    """Open /dev/null for each standard stream that is closed, as under `manycore ... >&-`.

    Call this before anything is opened: a file in the place of a stream would get what is printed.
    """
    for name, mode in (("stdin", "r"), ("stdout", "w"), ("stderr", "w")):
        if getattr(sys, name) is None:
            null = os.open(os.devnull, os.O_RDWR)  # the lowest descriptor that is free
            os.set_inheritable(null, True)
            setattr(sys, name, open(null, mode, closefd=False))  # noqa: SIM115


def leave_hung_up_terminal() -> None:
    """Discard further output if the terminal has hung up: each write to it would be an error."""
    outputs = select.poll()
    for descriptor in _OUTPUTS:
        outputs.register(descriptor, 0)
    for descriptor, event in outputs.poll(0):
        if event & select.POLLHUP:
            null = os.open(os.devnull, os.O_WRONLY)
            os.dup2(null, descriptor)
            os.close(null)
