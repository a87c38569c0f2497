# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Writer thread, so that a slow disk does not delay taking messages."""

from __future__ import annotations

import shlex
import threading
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.recording.metadata import TopicRow
from rmw_manycore_py.recording.output import Output

# Maximum time span lost by a kill.
FLUSH_PERIOD_S = 0.5


@dataclass(frozen=True)
class Taken:
    """A message taken from a topic."""

    row: TopicRow
    recorded_ns: int
    published_ns: int
    number: int
    data: bytes


class WritingThread:
    """Writes messages in the order they are queued."""

    _end = object()

    def __init__(self, output: Output, max_cache_bytes: int, failed: Callable[[], None]) -> None:
        """Start; `failed` is called when writing fails."""
        self._output, self._failed = output, failed
        self._max_cache_bytes = max_cache_bytes
        self._waiting: deque[Taken] = deque()
        self._waiting_bytes = 0
        self._ending = False
        self._changed = threading.Condition()
        self.failure: OSError | None = None
        self._thread = threading.Thread(target=self._run, name="writing")
        self._thread.start()

    def write(self, taken: Taken) -> None:
        """Queue a message; block while the cache is full.

        No-op after a failure.
        """
        with self._changed:
            while self._waiting_bytes > self._max_cache_bytes and self.failure is None:
                self._changed.wait()
            if self.failure is None:
                self._waiting.append(taken)
                self._waiting_bytes += len(taken.data)
                self._changed.notify_all()

    def finish(self, rows: list[TopicRow]) -> dict[str, Any]:
        """Write pending messages and the index; return the contents of metadata.yaml.

        :raises ManycoreError: if writing has failed; the file has complete chunks up to then.
        """
        with self._changed:
            self._ending = True
            self._changed.notify_all()
        self._thread.join()
        try:
            if self.failure is None:
                return self._output.finish(rows)
        except OSError as error:
            self.failure = error
        self._output.give_up()
        raise ManycoreError(
            f"{self._output.path}: cannot be written: {self.failure.strerror}; it holds "
            f"{self._output.whole_messages} messages up to then, without an index: "
            f"`manycore bag info {shlex.quote(str(self._output.path))}`"
        ) from self.failure

    def _run(self) -> None:
        flush_s: float | None = None  # when the current chunk has to be on disk
        try:
            while (taken := self._next(flush_s)) is not self._end:
                if isinstance(taken, Taken):
                    self._write(taken)
                    flush_s = flush_s or time.monotonic() + FLUSH_PERIOD_S
                if flush_s is not None and time.monotonic() >= flush_s:
                    self._output.flush()
                    flush_s = None
        except OSError as error:
            with self._changed:
                self.failure = error
                self._waiting.clear()
                self._changed.notify_all()
            self._failed()

    def _next(self, until_s: float | None) -> Taken | object | None:
        """Return the next message, the end marker, or None at `until_s`."""
        with self._changed:
            while not self._waiting:
                if self._ending:
                    return self._end
                left_s = None if until_s is None else until_s - time.monotonic()
                if left_s is not None and left_s <= 0:
                    return None
                self._changed.wait(left_s)
            return self._waiting.popleft()

    def _write(self, taken: Taken) -> None:
        self._output.write(
            taken.row, taken.recorded_ns, taken.published_ns, taken.number, taken.data
        )
        with self._changed:
            self._waiting_bytes -= len(taken.data)
            self._changed.notify_all()
