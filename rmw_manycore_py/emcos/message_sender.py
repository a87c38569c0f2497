# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The sending end of eMCOS messages."""

from __future__ import annotations

import os
from collections.abc import Iterable

from rmw_manycore_py.emcos.end import End
from rmw_manycore_py.emcos.errors import system_errors
from rmw_manycore_py.emcos.link import Note, NoteKind
from rmw_manycore_py.emcos.packets import (
    BODY_BYTES,
    PRIORITIES,
    Data,
    bytes_of,
    packet_count,
    packets_of,
)
from rmw_manycore_py.emcos.pipes import PipeWriter, create_pipe
from rmw_manycore_py.emcos.waiting import wait_for_any
from rmw_manycore_py.transport.arguments import Deadline, checked_number
from rmw_manycore_py.transport.errors import TransportError

# As for topics with `synchronous: true`.
SYNCHRONOUS_TIMEOUT_S = 0.1

_DROPPED = "it was dropped: send it again"
_IN_PIPE = (
    "it is in the pipe and may still be received: do not send it again; a later synchronous "
    "message of its priority confirms it, too"
)


class MessageSender(End):
    """Sends messages to the one `MessageReceiver` of the same name, through a pipe per priority.

    :ivar dropped: number of messages that did not reach a pipe in whole.
    """

    def __init__(
        self, name: str, *, platform: str | None = None, timeout_s: float | None = None
    ) -> None:
        """Wait for the other side.

        :param name: letters, digits and '_'.
        :param platform: names of different platforms are different; by default the environment's.
        :param timeout_s: in seconds; None waits indefinitely.
        :raises TransportTimeoutError: if the other side has not come within the timeout.
        :raises TransportError: if an argument is invalid, or the other side is no receiver.
        """
        super().__init__(name, platform, Deadline(timeout_s))
        self.dropped = 0
        self._pipes: dict[int, PipeWriter] = {}
        self._number = 0
        self._received = 0

    def send(
        self,
        data: Data,
        *,
        priority: int = 0,
        synchronous: bool = False,
        timeout_s: float = SYNCHRONOUS_TIMEOUT_S,
    ) -> bool:
        """Send a message; True once it is in the pipe, or, if synchronous, was received.

        An asynchronous message never waits: if the pipe has no room for all of it, it is dropped
        and counted, and False returned.

        :param data: bytes, a numpy array or another buffer; it may be empty.
        :param priority: 0 to 7, the highest is received first.
        :param synchronous: wait until the other side has received it.
        :param timeout_s: limit for all of a synchronous send, in seconds.
        :raises TransportTimeoutError: if a synchronous message was not received within the timeout.
            The text states whether it was dropped, or is in the pipe and may still be received.
        :raises PeerGoneError: if the other process has ended, or closed its end.
        :raises TransportError: if a message can never fit in the pipe, or an argument is invalid.
        """
        view = bytes_of(data)
        checked_number("priority", priority, 0, PRIORITIES - 1)
        self._take_notes()
        self._link.require_peer()
        with system_errors(self._subject):
            pipe = self._pipes.get(priority) or self._new_pipe(priority)
            if pipe is None:
                return self._drop()
            self._number += 1
            if synchronous:
                self._send_and_wait(pipe, view, timeout_s)
                return True
            return self._send_now(pipe, view)

    def close(self) -> None:
        """Close this end; messages in the pipes can still be received. Idempotent."""
        super().close()
        for priority in list(self._pipes):
            self._pipes.pop(priority).close()

    def _new_pipe(self, priority: int) -> PipeWriter | None:
        """Create the pipe of a priority; None if the link has no room for its descriptor."""
        read_end, write_end = create_pipe()
        try:
            told = self._link.tell(NoteKind.PIPE, priority, read_end)
        finally:
            os.close(read_end)
        if not told:
            os.close(write_end)
            return None
        self._pipes[priority] = PipeWriter(write_end)
        return self._pipes[priority]

    def _send_now(self, pipe: PipeWriter, data: memoryview) -> bool:
        count = packet_count(len(data))
        if count > pipe.capacity:
            raise TransportError(
                f"{self._subject}: expected at most {pipe.capacity * BODY_BYTES} bytes, which the "
                f"pipe holds, found {len(data)}; send it with synchronous=True, or as a segment"
            )
        if pipe.room() < count:
            return self._drop()
        return all(map(pipe.try_write, packets_of(data, self._number, False))) or self._drop()

    def _send_and_wait(self, pipe: PipeWriter, data: memoryview, timeout_s: float) -> None:
        deadline = Deadline(timeout_s)
        for packet in packets_of(data, self._number, True):
            while not pipe.try_write(packet):
                if not self._wait(deadline, [pipe.descriptor]):
                    self.dropped += 1
                    raise self._timeout("the pipe had no room", timeout_s, _DROPPED)
        while self._received != self._number:
            if not self._wait(deadline):
                raise self._timeout("the message was not yet received", timeout_s, _IN_PIPE)

    def _wait(self, deadline: Deadline, writable: Iterable[int] = ()) -> bool:
        """Sleep until there is a note, or room; False after the deadline."""
        self._link.require_peer()  # only now: its last note may be what this side waits for
        is_ready = wait_for_any(self._link.descriptors, deadline, writable)
        self._take_notes()
        return is_ready

    def _handle(self, note: Note) -> None:
        if note.kind == NoteKind.RECEIVED:
            self._received = note.value

    def _drop(self) -> bool:
        self.dropped += 1
        return False
