# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Output of a node, split into lines."""

from __future__ import annotations

import errno
import os
from collections import deque
from collections.abc import Callable
from typing import IO

READ_BYTES = 65536  # capacity of a pipe
LONGEST_LINE_BYTES = 65536  # longer lines are split, to bound memory
TAIL_LINES = 20  # holds a typical Python traceback


class OutputReader:
    """Reads a pipe or terminal without blocking; keeps the last lines for failure reports.

    :param tap: receives all bytes as they are read, for attached clients.
    """

    def __init__(self, stream: IO[bytes], tap: Callable[[bytes], None] | None = None) -> None:
        self._stream = stream
        self._tap = tap
        self._partial = b""
        self.tail: deque[str] = deque(maxlen=TAIL_LINES)
        self.at_end = False  # all writers have closed
        os.set_blocking(stream.fileno(), False)

    def fileno(self) -> int:
        """Return the descriptor, for selectors."""
        return self._stream.fileno()

    def read_lines(self) -> list[str]:
        """Return the complete lines read so far."""
        *lines, self._partial = (self._partial + self._read()).split(b"\n")
        if len(self._partial) >= LONGEST_LINE_BYTES:
            lines.append(self._partial)
            self._partial = b""
        return self._keep(lines)

    def close(self) -> list[str]:
        """Close the stream; return the remaining lines, including an incomplete last one."""
        rest = self._partial
        while data := self._read():
            rest += data
        self._stream.close()
        self._partial = b""
        return self._keep(rest.removesuffix(b"\n").split(b"\n") if rest else [])

    def _read(self) -> bytes:
        """Return available bytes; empty if there are none."""
        try:
            data = os.read(self._stream.fileno(), READ_BYTES)
        except BlockingIOError:
            return b""
        except OSError as error:
            if error.errno != errno.EIO:
                raise
            data = b""  # terminal closed by its last user
        self.at_end = not data
        if self._tap and data:
            self._tap(data)
        return data

    def _keep(self, lines: list[bytes]) -> list[str]:
        texts = [line.decode(errors="replace").rstrip("\r") for line in lines]
        self.tail.extend(texts)
        return texts
