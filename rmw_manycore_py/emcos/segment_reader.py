# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The reading end of one-sided transfers."""

from __future__ import annotations

import numpy as np

from rmw_manycore_py.emcos.errors import system_errors
from rmw_manycore_py.emcos.link import NoteKind
from rmw_manycore_py.emcos.memory import Bytes
from rmw_manycore_py.emcos.receiving_end import ReceivingEnd
from rmw_manycore_py.transport.arguments import Deadline


class SegmentReader(ReceivingEnd[Bytes]):
    """Takes the segments of the one `SegmentWriter` of the same name, without a copy.

    Iterating yields segments until the writer closes its end, and raises a PeerGoneError if it
    ended without.
    """

    def __init__(
        self, name: str, *, platform: str | None = None, timeout_s: float | None = None
    ) -> None:
        """Wait for the other side; parameters and errors are those of `MessageSender`."""
        super().__init__(name, platform, Deadline(timeout_s))

    def take(self, timeout_s: float | None = None) -> Bytes:
        """Sleep until there is a segment, and return the oldest one.

        What the writer had put before it ended is taken all the same.

        :param timeout_s: in seconds; None waits indefinitely.
        :return: the segment, which is the caller's, and freed with the last array that views it.
        :raises TransportTimeoutError: if no segment came within the timeout.
        :raises PeerGoneError: if no segment is left, and the other process has ended or closed.
        """
        return self._sleep_until(self._next, "segment", timeout_s)

    def _receive(self) -> Bytes:
        return self.take()

    def _next(self) -> Bytes | None:
        """Return the oldest segment; others stay in the link, so that it can be full."""
        self._link.require_open()
        with system_errors(self._subject):
            while note := self._link.take_note():
                if note.kind == NoteKind.SEGMENT:
                    empty = note.value == 0
                    return np.zeros(0, np.uint8) if empty else self._memory_of(note, note.value)
        return None
