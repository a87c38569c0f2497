# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What all ends of transfers have in common."""

from __future__ import annotations

import os

from rmw_manycore_py.emcos.errors import system_errors
from rmw_manycore_py.emcos.link import Note
from rmw_manycore_py.emcos.memory import Bytes, map_memory
from rmw_manycore_py.emcos.opening import open_link, subject_of
from rmw_manycore_py.transport.arguments import Deadline
from rmw_manycore_py.transport.closing import Closing
from rmw_manycore_py.transport.errors import TransportError, TransportTimeoutError


class End(Closing):
    """One end of a transfer, closed at the end of its `with`; for one thread at a time.

    A child of fork() inherits no end: there every call raises.

    :ivar name: name of the transfer.
    """

    def __init__(
        self, name: str, platform: str | None, deadline: Deadline, size_bytes: int = 0
    ) -> None:
        own_class = type(self).__name__
        self.name = name
        self._subject = subject_of(own_class, name)
        self._link = open_link(own_class, name, platform, deadline, size_bytes)

    def __repr__(self) -> str:
        return f"<{self._subject}>"

    def close(self) -> None:
        """Close this end; the other one learns of it. Idempotent."""
        self._link.close()

    def _take_notes(self) -> None:
        """Handle the notes of the other side."""
        self._link.require_open()
        with system_errors(self._subject):
            while note := self._link.take_note():
                self._handle(note)

    def _handle(self, note: Note) -> None:
        """Handle one note; most kinds are for other ends."""

    def _descriptor_of(self, note: Note) -> int:
        if note.descriptor is None:
            raise TransportError(
                f"{self._subject}: a descriptor from the other side was lost, as this process has "
                "too many open files; close some, or raise the limit (ulimit -n)"
            )
        return note.descriptor

    def _memory_of(self, note: Note, size_bytes: int) -> Bytes:
        descriptor = self._descriptor_of(note)
        try:
            return map_memory(descriptor, size_bytes)
        finally:
            os.close(descriptor)

    def _timeout(
        self, what: str, timeout_s: float | None, advice: str = ""
    ) -> TransportTimeoutError:
        text = f"{self._subject}: {what} within {timeout_s:g} s"
        return TransportTimeoutError(f"{text}; {advice}" if advice else text)
