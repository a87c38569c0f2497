# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Bounded log of one node, with a timestamp per line."""

from __future__ import annotations

import os
import time
from contextlib import suppress
from functools import lru_cache
from pathlib import Path

from rmw_manycore_py.ros.names import file_stem

# Limit per node in a run of few nodes; many nodes share MAX_RUN_BYTES.
MAX_NODE_BYTES = 8 << 20
MIN_NODE_BYTES = 64 << 10
MAX_RUN_BYTES = 256 << 20
SUFFIX, OLDER_SUFFIX = ".log", ".log.1"
RUN_LOG = "(run)"  # in place of a node's name: that of the run itself, as no node is called
_SECOND = "%Y-%m-%dT%H:%M:%S"
TIME_CHARACTERS = len("2026-01-01T00:00:00.000000Z")


def share_of(nodes: int) -> int:
    """Return the limit in bytes for each of `nodes` nodes."""
    return max(min(MAX_NODE_BYTES, MAX_RUN_BYTES // max(nodes, 1)), MIN_NODE_BYTES)


def log_path(directory: Path, node: str, suffix: str = SUFFIX) -> Path:
    """Return the log path of a node."""
    return directory / f"{file_stem(node)}{suffix}"


class LogFile:
    """Appends lines; when full, drops the older half.

    Counts lines that cannot be written, and logs their number once there is room again.
    """

    def __init__(self, directory: Path, node: str, max_bytes: int) -> None:
        self._path = log_path(directory, node)
        self._older = log_path(directory, node, OLDER_SUFFIX)
        self._half_bytes = max_bytes // 2
        self._descriptor = -1
        self._size_bytes = 0
        self._is_torn = False  # the last line is incomplete
        self._unwritten = 0
        self._reason = ""

    def write(self, text: str) -> str | None:
        """Append a line; return the reason if it is the first one that cannot be written."""
        try:
            self._append(self._gap() + _stamped(text))
        except OSError as error:
            self._unwritten += 1
            is_first, self._reason = not self._reason, error.strerror or str(error)
            return self._reason if is_first else None
        self._unwritten = 0
        return None

    def close(self) -> None:
        """Close the file, after recording the number of lines lost at its end."""
        with suppress(OSError):
            if gap := self._gap():
                self._append(gap)
        self._close()

    def _gap(self) -> bytes:
        """Return what has to precede the next line."""
        end = b"\n" if self._is_torn else b""
        if not self._unwritten:
            return end
        return end + _stamped(f"({self._unwritten} lines were not written: {self._reason})")

    def _close(self) -> None:
        if self._descriptor >= 0:
            os.close(self._descriptor)
            self._descriptor = -1

    def _append(self, data: bytes) -> None:
        if self._descriptor < 0 or self._size_bytes + len(data) > self._half_bytes:
            self._begin_file()
        while data:
            written = os.write(self._descriptor, data)
            self._size_bytes += written
            self._is_torn = written < len(data)
            data = data[written:]

    def _begin_file(self) -> None:
        self._close()
        with suppress(FileNotFoundError):
            os.replace(self._path, self._older)
        flags = os.O_WRONLY | os.O_CREAT | os.O_APPEND
        self._descriptor = os.open(self._path, flags, 0o600)
        self._size_bytes = 0
        self._is_torn = False


def _stamped(text: str) -> bytes:
    now_us = time.time_ns() // 1000
    second = _second_text(now_us // 1_000_000)
    return f"{second}.{now_us % 1_000_000:06}Z {text}\n".encode(errors="replace")


@lru_cache(maxsize=1)
def _second_text(second: int) -> str:
    return time.strftime(_SECOND, time.gmtime(second))
