# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A message that is put together from the packets of one pipe."""

from __future__ import annotations

from rmw_manycore_py.emcos.packets import Packet


class Assembly:
    """Takes the packets of one pipe, which come whole and in order."""

    def __init__(self) -> None:
        self._data = bytearray()

    def add(self, packet: Packet) -> bytes | None:
        """Add a packet; return the message if it was the last one.

        A message that begins supersedes one whose sender gave up.
        """
        if packet.offset == 0:
            self._data = bytearray()
        self._data += packet.body
        return bytes(self._data) if len(self._data) == packet.size else None
