# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The writing end of one-sided transfers: each message has a segment of its own."""

from __future__ import annotations

import os

import numpy as np

from rmw_manycore_py.emcos.end import End
from rmw_manycore_py.emcos.errors import system_errors
from rmw_manycore_py.emcos.link import NoteKind
from rmw_manycore_py.emcos.memory import create_memory, map_memory
from rmw_manycore_py.emcos.packets import Data, bytes_of
from rmw_manycore_py.transport.arguments import Deadline


class SegmentWriter(End):
    """Puts messages into segments, and gives them to the one `SegmentReader` of the same name.

    :ivar dropped: number of messages that the link had no room for.
    """

    def __init__(
        self, name: str, *, platform: str | None = None, timeout_s: float | None = None
    ) -> None:
        """Wait for the other side; parameters and errors are those of `MessageSender`."""
        super().__init__(name, platform, Deadline(timeout_s))
        self.dropped = 0

    def put(self, data: Data) -> bool:
        """Copy a message into a new segment, without the other side; never waits.

        The segment is the other side's from then on: it outlives this end and this process.

        :param data: bytes, a numpy array or another buffer; it may be empty.
        :return: False if segments that the other side has not taken fill the link: this one is
            dropped, and counted.
        :raises PeerGoneError: if the other process has ended, or closed its end.
        :raises TransportError: if there is no memory for the segment.
        """
        view = bytes_of(data)
        self._take_notes()
        self._link.require_peer()
        with system_errors(self._subject):
            told = self._put(view) if view.nbytes else self._link.tell(NoteKind.SEGMENT)
        self.dropped += not told
        return told

    def _put(self, data: memoryview) -> bool:
        descriptor = create_memory(data.nbytes, self._subject)
        try:
            segment = map_memory(descriptor, data.nbytes)
            np.copyto(segment, np.frombuffer(data, np.uint8))
            return self._link.tell(NoteKind.SEGMENT, data.nbytes, descriptor)
        finally:
            os.close(descriptor)
