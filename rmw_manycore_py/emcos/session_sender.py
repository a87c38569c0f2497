# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The sending end of a session."""

from __future__ import annotations

import os

import numpy as np

from rmw_manycore_py.emcos.errors import system_errors
from rmw_manycore_py.emcos.link import Note, NoteKind
from rmw_manycore_py.emcos.memory import Bytes
from rmw_manycore_py.emcos.session_end import SessionEnd
from rmw_manycore_py.emcos.uc import Uc
from rmw_manycore_py.transport.arguments import Deadline, checked_number
from rmw_manycore_py.transport.errors import refusal

_NOT_BEGUN = "this one was not begun: send it again"
_PENDING = "it will be, once the other side releases its own: wait() before writing it"


class SessionSender(SessionEnd):
    """Has a UC, a thread, move its buffer to that of the one `SessionReceiver` of the same name.

    ```python
    with emcos.SessionSender("image", 640 * 480) as session:
        session.buffer[:] = pixels.reshape(-1)
        session.send()                # returns at once
        session.wait()                # before the buffer is written again
    ```

    :ivar dropped: number of transfers that were refused, as the last one was not moved yet.
    """

    def __init__(
        self,
        name: str,
        size_bytes: int,
        *,
        host_cpu: int | None = None,
        platform: str | None = None,
        timeout_s: float | None = None,
    ) -> None:
        """Wait for the other side and its buffer.

        :param name: letters, digits and '_'.
        :param size_bytes: size of the buffers, the same at both ends.
        :param host_cpu: pins the UC; by default it runs where this process may run.
        :param platform: names of different platforms are different; by default the environment's.
        :param timeout_s: in seconds; None waits indefinitely.
        :raises TransportTimeoutError: if the other side has not come within the timeout.
        :raises PeerGoneError: if it ended before the session was open.
        :raises TransportError: if an argument is invalid, the other side is no receiver of this
            size, or this process has eight sessions to others.
        """
        if host_cpu is not None and host_cpu not in os.sched_getaffinity(0):
            allowed = sorted(os.sched_getaffinity(0))
            raise refusal("host_cpu", f"one of {allowed}, which this process may use", host_cpu)
        deadline = Deadline(timeout_s)
        super().__init__(name, size_bytes, platform, deadline)
        self.dropped = 0
        self._uc: Uc | None = None
        self._target: Bytes | None = None
        try:
            with system_errors(self._subject):
                self._buffer = np.zeros(size_bytes, np.uint8)
                self._uc = Uc(self._link, self._buffer, self._opened(deadline, timeout_s), host_cpu)
        except BaseException:
            self.close()
            raise

    @property
    def buffer(self) -> Bytes:
        """The send buffer: the UC's from `send` until `wait` has returned, else the program's."""
        return self._buffer

    def send(
        self,
        size_bytes: int | None = None,
        *,
        synchronous: bool = False,
        timeout_s: float | None = None,
    ) -> bool:
        """Have the UC move the beginning of the buffer, once the other side has released its own.

        :param size_bytes: how much, from 0; by default all.
        :param synchronous: wait until it was moved.
        :param timeout_s: limit of a synchronous send, in seconds; None waits indefinitely.
        :return: False if the last transfer was not moved yet: this one is dropped, and counted.
        :raises TransportTimeoutError: if a synchronous transfer was not moved within the timeout.
            The text states whether it was not begun, or will still be moved.
        :raises PeerGoneError: if the other process has ended, or closed its end.
        """
        size = self.size_bytes if size_bytes is None else size_bytes
        checked_number("size_bytes", size, 0, self.size_bytes)
        deadline = Deadline(timeout_s)
        with system_errors(self._subject):
            uc = self._opened_uc()
            if synchronous and not uc.wait(deadline):
                raise self._timeout("the last transfer was not yet moved", timeout_s, _NOT_BEGUN)
            if not uc.request(size):
                self.dropped += 1
                return False
        if synchronous:
            self._wait(deadline, timeout_s)
        return True

    def wait(self, timeout_s: float | None = None) -> None:
        """Sleep until the buffer was moved, and may be written again.

        :param timeout_s: in seconds; None waits indefinitely.
        :raises TransportTimeoutError: if it was not moved within the timeout.
        :raises PeerGoneError: if the other process has ended, or closed its end.
        """
        self._wait(Deadline(timeout_s), timeout_s)

    def close(self) -> None:
        """Close this end; a transfer that the UC did not begin is given up. Idempotent."""
        uc, self._uc = self._uc, None
        if uc is not None and self._link.is_open:
            uc.close()
        super().close()

    def _wait(self, deadline: Deadline, timeout_s: float | None) -> None:
        if not self._opened_uc().wait(deadline):
            raise self._timeout("the buffer was not yet moved", timeout_s, _PENDING)
        self._link.require_peer()

    def _opened_uc(self) -> Uc:
        self._link.require_open()
        assert self._uc is not None
        return self._uc

    def _opened(self, deadline: Deadline, timeout_s: float | None) -> Bytes:
        """Return the other side's buffer."""
        while True:
            self._take_notes()
            if self._target is not None:
                return self._target
            self._link.require_peer()
            if not self._link.wait(deadline):
                raise self._timeout("the other side has made no buffer", timeout_s)

    def _handle(self, note: Note) -> None:
        if note.kind == NoteKind.BUFFER:
            self._target = self._memory_of(note, self.size_bytes)
