# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The UC of one session: a thread that copies the send buffer to the receive buffer.

```
 idle ── request ──► waits until the receive buffer is released ──► copies ──► sends MOVED ──► idle
                     └── the peer has gone, or close() ──► idle, nothing was moved
```

The link belongs to the thread while a request is pending, and else to the thread that requests.
"""

from __future__ import annotations

import os
import queue
import threading

import numpy as np

from rmw_manycore_py.emcos.link import Link, NoteKind
from rmw_manycore_py.emcos.memory import Bytes
from rmw_manycore_py.emcos.waiting import wait_for_any
from rmw_manycore_py.transport.arguments import Deadline

_NEVER = Deadline(None)


class Uc:
    """A copying thread; pinned to a host CPU if one is given."""

    def __init__(self, link: Link, source: Bytes, target: Bytes, host_cpu: int | None) -> None:
        self._link = link
        self._source = source
        self._target = target
        self._is_free = True
        self._is_pending = False
        self._changed = threading.Condition()
        self._requests: queue.SimpleQueue[int | None] = queue.SimpleQueue()
        self._closing = os.eventfd(0)
        self._thread = threading.Thread(target=self._run, name="manycore_uc", daemon=True)
        self._thread.start()
        if host_cpu is not None:
            self._pin(host_cpu)

    def request(self, size_bytes: int) -> bool:
        """Request a move of `size_bytes`; False while the last request is pending.

        :raises PeerGoneError: if the other process has ended, or closed its end.
        """
        if self._is_pending:
            return False
        self._take_notes()
        self._link.require_peer()
        self._is_pending = True
        self._requests.put(size_bytes)
        return True

    def wait(self, deadline: Deadline) -> bool:
        """Sleep until no request is pending; False after the deadline."""
        with self._changed:
            return self._changed.wait_for(lambda: not self._is_pending, deadline.left_s())

    def close(self) -> None:
        """End the thread; a request that is not being copied yet is given up."""
        self._requests.put(None)
        os.eventfd_write(self._closing, 1)
        self._thread.join()
        os.close(self._closing)

    def _pin(self, host_cpu: int) -> None:
        assert self._thread.native_id is not None
        try:
            os.sched_setaffinity(self._thread.native_id, {host_cpu})
        except OSError:
            self.close()
            raise

    def _run(self) -> None:
        while (size_bytes := self._requests.get()) is not None:
            if self._is_released():
                np.copyto(self._target[:size_bytes], self._source[:size_bytes])
                self._is_free = False
                self._link.tell(NoteKind.MOVED, size_bytes)
            with self._changed:
                self._is_pending = False
                self._changed.notify_all()

    def _is_released(self) -> bool:
        """Sleep until the receive buffer is free; False if the peer has gone, or at close()."""
        while True:
            self._take_notes()
            if self._is_free or self._link.is_gone:
                return not self._link.is_gone
            wait_for_any([*self._link.descriptors, self._closing], _NEVER)
            if not self._requests.empty():  # pending, so the next one can only be that to end
                return False

    def _take_notes(self) -> None:
        while note := self._link.take_note():
            self._is_free = self._is_free or note.kind == NoteKind.RELEASED
