# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A user at a terminal, here a pseudo-terminal."""

from __future__ import annotations

import codecs
import fcntl
import os
import pty
import re
import select
import struct
import subprocess
import termios
import time
from pathlib import Path

from support import TIMEOUT_S


class Person:
    """A user at a terminal of their own, with a program that runs in it."""

    def __init__(self, command: list[str | Path], env: dict[str, str]) -> None:
        self._terminal, theirs = pty.openpty()
        self.resize(30, 90)
        self.before = termios.tcgetattr(theirs)
        self._theirs = theirs
        self.seen = ""
        self._decoder = codecs.getincrementaldecoder("utf-8")()
        self.process = subprocess.Popen(
            ["setsid", "--ctty", *command], env=env, stdin=theirs, stdout=theirs, stderr=theirs
        )

    def resize(self, rows: int, columns: int) -> None:
        fcntl.ioctl(self._terminal, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, 0, 0))

    def type(self, keys: str) -> None:
        os.write(self._terminal, keys.encode())

    def sees(self, pattern: str) -> re.Match[str]:
        """Return the next match; output before it is then discarded."""
        deadline = time.monotonic() + TIMEOUT_S
        while not (match := re.search(pattern, self.seen)):
            left_s = max(0, deadline - time.monotonic())
            assert select.select([self._terminal], [], [], left_s)[0], (pattern, self.seen)
            self.seen += self._decoder.decode(os.read(self._terminal, 4096))
        self.seen = self.seen[match.end() :]
        return match

    def leaves(self) -> int:
        """Return the exit status; check that the terminal has its original settings."""
        status = self.process.wait(TIMEOUT_S)
        assert termios.tcgetattr(self._theirs) == self.before
        return status

    def hangs_up(self) -> None:
        """Close the terminal, as its window or connection does."""
        null = os.open(os.devnull, os.O_RDWR)
        os.dup2(null, self._terminal)
        os.close(null)

    def close(self) -> None:
        self.process.kill()
        self.process.wait()
        os.close(self._terminal)
        os.close(self._theirs)
