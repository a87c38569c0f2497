# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Reads the logs of runs, including new lines."""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from heapq import merge
from pathlib import Path

from rmw_manycore_py.launch.runs.directory import RunDirectory
from rmw_manycore_py.launch.runs.log_file import OLDER_SUFFIX, TIME_CHARACTERS, log_path


@dataclass(frozen=True, order=True)
class LogLine:
    """A line of a node; timestamps sort as text."""

    time: str
    node: str
    text: str


class NodeLog:
    """Incremental reader of the log of a node, or of the run.

    :param shown: the name in the lines, if it is another one.
    """

    def __init__(self, run: RunDirectory, node: str, shown: str = "") -> None:
        self.node = shown or node
        self._path = log_path(run.logs, node)
        self._older = log_path(run.logs, node, OLDER_SUFFIX)
        self._descriptor = -1
        self._rest = b""
        self._last_time = ""

    def read(self) -> list[LogLine]:
        """Return the lines since the last call; at first, including the older file."""
        lines: list[LogLine] = []
        if self._descriptor < 0:
            if not self._open(self._older):
                self._open(self._path)
            elif self._path.exists():
                lines += self._lines()
                self._open(self._path)
        lines += self._lines()
        if self._descriptor >= 0 and self._was_replaced() and self._open(self._path):
            lines += self._lines()
        return lines

    def close(self) -> None:
        """Close the file."""
        if self._descriptor >= 0:
            os.close(self._descriptor)
            self._descriptor = -1

    def _open(self, path: Path) -> bool:
        with suppress(FileNotFoundError):
            descriptor = os.open(path, os.O_RDONLY)
            self.close()
            self._descriptor, self._rest = descriptor, b""
            return True
        return False

    def _was_replaced(self) -> bool:
        with suppress(FileNotFoundError):
            return os.stat(self._path).st_ino != os.fstat(self._descriptor).st_ino
        return False

    def _lines(self) -> list[LogLine]:
        if self._descriptor < 0:
            return []
        data = self._rest
        while more := os.read(self._descriptor, 1 << 20):
            data += more
        *complete, self._rest = data.split(b"\n")
        return [self._line(line.decode(errors="replace")) for line in complete if line]

    def _line(self, text: str) -> LogLine:
        time, rest = text[:TIME_CHARACTERS], text[TIME_CHARACTERS + 1 :]
        if not time.endswith("Z"):  # remainder of a line truncated by a full disk
            return LogLine(self._last_time, self.node, text)
        self._last_time = time
        return LogLine(time, self.node, rest)


def in_order(logs: Iterable[NodeLog], tail: int | None = None) -> Iterator[LogLine]:
    """Yield new lines of several logs in time order, at most the last `tail` of each."""
    news = (log.read() for log in logs)
    # The clock may have been set back, so lines of one node keep their order.
    parts = (deque(lines, maxlen=tail) for lines in news)
    yield from merge(*parts, key=lambda line: line.time)
