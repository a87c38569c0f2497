# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What a node prints, cut into lines."""

from __future__ import annotations

import errno
import os
from collections import deque
from collections.abc import Callable
from typing import IO

READ_BYTES = 65536  # what a pipe holds
LONGEST_LINE_BYTES = 65536  # a longer one is cut, so that memory stays bounded
TAIL_LINES = 20  # a python traceback of a usual depth


class OutputReader:
    """Reads a pipe or terminal without waiting; keeps the last lines for the report of a failure.

    :param tap: gets all that is read as it comes, for those who are attached to the node.
    """

    def __init__(self, stream: IO[bytes], tap: Callable[[bytes], None] | None = None) -> None:
        self._stream = stream
        self._tap = tap
        self._partial = b""
        self.tail: deque[str] = deque(maxlen=TAIL_LINES)
        self.at_end = False  # everyone who could have written is gone
        os.set_blocking(stream.fileno(), False)

    def fileno(self) -> int:
        """Return the descriptor, for selectors."""
        return self._stream.fileno()

    def read_lines(self) -> list[str]:
        """Return the lines that are complete by now."""
        *lines, self._partial = (self._partial + self._read()).split(b"\n")
        if len(self._partial) >= LONGEST_LINE_BYTES:
            lines.append(self._partial)
            self._partial = b""
        return self._keep(lines)

    def close(self) -> list[str]:
        """Close the stream; return the lines still in it, the last one even without its end."""
        rest = self._partial
        while data := self._read():
            rest += data
        self._stream.close()
        self._partial = b""
        return self._keep(rest.removesuffix(b"\n").split(b"\n") if rest else [])

    def _read(self) -> bytes:
        """Return what is there; nothing, too, while the stream is empty."""
        try:
            data = os.read(self._stream.fileno(), READ_BYTES)
        except BlockingIOError:
            return b""
        except OSError as error:
            if error.errno != errno.EIO:
                raise
            data = b""  # of a terminal: its last user is gone
        self.at_end = not data
        if self._tap and data:
            self._tap(data)
        return data

    def _keep(self, lines: list[bytes]) -> list[str]:
        texts = [line.decode(errors="replace").rstrip("\r") for line in lines]
        self.tail.extend(texts)
        return texts
