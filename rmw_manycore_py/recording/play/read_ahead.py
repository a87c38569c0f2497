# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Read-ahead thread, so that a slow disk does not delay messages."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Iterable, Iterator

from rmw_manycore_py.recording.input import Recorded

# Maximum memory for messages read ahead; at least one message.
MAX_BYTES = 64 << 20


class ReadAhead:
    """Yields the items of another iterator, and raises its errors."""

    def __init__(self, messages: Iterable[Recorded]) -> None:
        self._messages = messages
        self._ready: deque[Recorded] = deque()
        self._bytes = 0
        self._is_over = False
        self._error: BaseException | None = None
        self._changed = threading.Condition()
        self._thread = threading.Thread(target=self._read, name="reading")
        self._thread.start()

    def _read(self) -> None:
        try:
            for message in self._messages:
                with self._changed:
                    while self._bytes > MAX_BYTES and not self._is_over:
                        self._changed.wait()
                    if self._is_over:
                        return
                    self._ready.append(message)
                    self._bytes += len(message.data)
                    self._changed.notify_all()
        except BaseException as error:
            self._error = error
        finally:
            with self._changed:
                self._is_over = True
                self._changed.notify_all()

    def __iter__(self) -> Iterator[Recorded]:
        while True:
            with self._changed:
                while not self._ready and not self._is_over:
                    self._changed.wait()
                if not self._ready:
                    break
                message = self._ready.popleft()
                self._bytes -= len(message.data)
                self._changed.notify_all()
            yield message
        if self._error is not None:
            raise self._error

    def close(self) -> None:
        """Stop the thread."""
        with self._changed:
            self._is_over = True
            self._ready.clear()
            self._changed.notify_all()
        self._thread.join()
