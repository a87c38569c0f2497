# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Standard streams of a node: a pipe, or a terminal of its own."""

from __future__ import annotations

import fcntl
import os
import struct
import subprocess
import termios
from collections.abc import Callable
from typing import IO, Any

# Size of a terminal without an attached client, so that programs wrap lines sensibly.
_ROWS, _COLUMNS = 24, 80


class Pipe:
    """Output to a pipe, no standard input."""

    options: dict[str, Any]

    def __init__(self) -> None:
        self._reader, self._writer = os.pipe()
        self.options = {
            "stdin": subprocess.DEVNULL,
            "stdout": self._writer,
            "stderr": self._writer,
        }

    @staticmethod
    def take() -> None:
        """Do nothing in the new process: a pipe needs no set-up."""

    def opened(self) -> IO[bytes]:
        """Return the runner's end, after the node has been started."""
        os.close(self._writer)
        return os.fdopen(self._reader, "rb", buffering=0)

    def discard(self) -> None:
        """Close both ends after a failed start."""
        os.close(self._writer)
        os.close(self._reader)


class Terminal(Pipe):
    """Pseudo-terminal whose master side is held by the runner."""

    def __init__(self) -> None:
        self._reader, self._writer = os.openpty()
        set_size(self._reader, _ROWS, _COLUMNS)
        streams = ("stdin", "stdout", "stderr")
        self.options = dict.fromkeys(streams, self._writer)

    @staticmethod
    def take() -> None:
        """Make it the controlling terminal of the new session, for Ctrl-C and /dev/tty."""
        fcntl.ioctl(0, termios.TIOCSCTTY, 0)


def set_size(terminal: int, rows: int, columns: int) -> None:
    """Set the size; the kernel sends SIGWINCH to the foreground process group."""
    fcntl.ioctl(terminal, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, 0, 0))


def before_exec(dies: Callable[[], None], streams: Pipe) -> Callable[[], None]:
    """Return the function that the new process runs between fork and exec."""
    take = streams.take

    def both() -> None:
        dies()
        take()

    return both
