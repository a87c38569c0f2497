# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The receiving end of eMCOS messages."""

from __future__ import annotations

from rmw_manycore_py.emcos.assembly import Assembly
from rmw_manycore_py.emcos.link import Note, NoteKind
from rmw_manycore_py.emcos.packets import ALL_PRIORITIES, PRIORITIES, Message, Packet
from rmw_manycore_py.emcos.pipes import PipeReader
from rmw_manycore_py.emcos.receiving_end import ReceivingEnd
from rmw_manycore_py.transport.arguments import Deadline, checked_number


class MessageReceiver(ReceivingEnd[Message]):
    """Receives the messages of the one `MessageSender` of the same name.

    Iterating yields messages until the sender closes its end, and raises a PeerGoneError if it
    ended without.
    """

    def __init__(
        self, name: str, *, platform: str | None = None, timeout_s: float | None = None
    ) -> None:
        """Wait for the other side; parameters and errors are those of `MessageSender`."""
        super().__init__(name, platform, Deadline(timeout_s))
        self._pipes: dict[int, PipeReader] = {}
        self._assemblies = {priority: Assembly() for priority in range(PRIORITIES)}

    def receive(self, *, mask: int = ALL_PRIORITIES, timeout_s: float | None = None) -> Message:
        """Sleep until there is a message, and return it: the highest priority first.

        What the sender had sent before it ended is received all the same, except for a message
        that was not sent in whole.

        :param mask: priorities to receive, as of `mask_of`; messages of others stay in their pipes.
        :param timeout_s: in seconds; None waits indefinitely.
        :raises TransportTimeoutError: if no message came within the timeout.
        :raises PeerGoneError: if no message is left, and the other process has ended or closed.
        """
        checked_number("mask", mask, 1, ALL_PRIORITIES)

        def pipes() -> list[int]:
            return [p for p in sorted(self._pipes, reverse=True) if mask >> p & 1]

        def look() -> Message | None:
            self._take_notes()
            return self._next(pipes())

        def readable() -> list[int]:
            return [self._pipes[priority].descriptor for priority in pipes()]

        return self._sleep_until(look, "message", timeout_s, readable)

    def close(self) -> None:
        """Close this end; messages that were not received are lost. Idempotent."""
        super().close()
        for priority in list(self._pipes):
            self._pipes.pop(priority).close()

    def _receive(self) -> Message:
        return self.receive()

    def _next(self, pipes: list[int]) -> Message | None:
        """Return a message of the highest priority; after each packet a higher one goes first."""
        while found := self._first_packet(pipes):
            priority, packet = found
            data = self._assemblies[priority].add(packet)
            if data is not None:
                if packet.is_synchronous and not self._link.is_gone:
                    self._link.tell(NoteKind.RECEIVED, packet.number)
                return Message(priority, data)
        return None

    def _first_packet(self, pipes: list[int]) -> tuple[int, Packet] | None:
        for priority in pipes:
            if packet := self._pipes[priority].try_read():
                return priority, packet
        return None

    def _handle(self, note: Note) -> None:
        if note.kind == NoteKind.PIPE:
            self._pipes[note.value] = PipeReader(self._descriptor_of(note))
