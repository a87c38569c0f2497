# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The receiving end of a session."""

from __future__ import annotations

import os

from rmw_manycore_py.emcos.errors import system_errors
from rmw_manycore_py.emcos.link import Note, NoteKind
from rmw_manycore_py.emcos.memory import Bytes, create_memory, map_memory
from rmw_manycore_py.emcos.receiving_end import ReceivingEnd
from rmw_manycore_py.emcos.session_end import SessionEnd
from rmw_manycore_py.transport.arguments import Deadline


class SessionReceiver(SessionEnd, ReceivingEnd[Bytes]):
    """Receives what the one `SessionSender` of the same name has its UC move.

    Iterating yields transfers until the sender closes its end, and raises a PeerGoneError if it
    ended without.
    """

    def __init__(
        self,
        name: str,
        size_bytes: int,
        *,
        platform: str | None = None,
        timeout_s: float | None = None,
    ) -> None:
        """Wait for the other side, then make the receive buffer; see `SessionSender`.

        :raises TransportError: also if there is no memory for the buffer.
        """
        super().__init__(name, size_bytes, platform, Deadline(timeout_s))
        self._moved: int | None = None
        self._is_held = False
        try:
            with system_errors(self._subject):
                self._buffer = self._shared_buffer()
        except BaseException:
            self.close()
            raise

    def receive(self, timeout_s: float | None = None) -> Bytes:
        """Release the buffer, sleep until something was moved there, and return it.

        :param timeout_s: in seconds; None waits indefinitely.
        :return: the beginning of the buffer, read-only: the next transfer overwrites it once the
            buffer is released.
        :raises TransportTimeoutError: if nothing came within the timeout.
        :raises PeerGoneError: if nothing is left, and the other process has ended or closed.
        """
        self.release()
        return self._sleep_until(self._next, "transfer", timeout_s)

    def release(self) -> None:
        """Give the buffer back to the UC, if it is held; `receive` does so, too."""
        self._take_notes()
        if self._is_held and not self._link.is_gone:
            self._link.tell(NoteKind.RELEASED)
        self._is_held = False

    def _receive(self) -> Bytes:
        return self.receive()

    def _next(self) -> Bytes | None:
        self._take_notes()
        if self._moved is None:
            return None
        array = self._buffer[: self._moved]
        array.flags.writeable = False
        self._moved, self._is_held = None, True
        return array

    def _shared_buffer(self) -> Bytes:
        descriptor = create_memory(self.size_bytes, self._subject)
        try:
            self._link.tell(NoteKind.BUFFER, self.size_bytes, descriptor)
            return map_memory(descriptor, self.size_bytes)
        finally:
            os.close(descriptor)

    def _handle(self, note: Note) -> None:
        if note.kind == NoteKind.MOVED:
            self._moved = note.value
