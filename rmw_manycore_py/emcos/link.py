# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The connection of the two sides of a transfer: notes and descriptors, and the end of the peer.

A link is a pair of sockets. The kernel closes a process's socket however the process ends, so each
side learns of the other's death from the link, and nothing else is waited on.
"""

from __future__ import annotations

import errno
import os
import socket
import struct
import weakref
from enum import IntEnum
from typing import NamedTuple

from rmw_manycore_py.emcos.errors import PeerGoneError
from rmw_manycore_py.emcos.memory import remove_names_of_the_dead
from rmw_manycore_py.emcos.waiting import wait_for_any
from rmw_manycore_py.transport.arguments import Deadline
from rmw_manycore_py.transport.errors import TransportError


class NoteKind(IntEnum):
    """Kind of a note from one side to the other."""

    PIPE = 1  # message: value = priority; with the pipe's read end
    RECEIVED = 2  # synchronous message: value = its number
    BUFFER = 3  # session: value = size; with the receive buffer
    MOVED = 4  # session: value = bytes in the receive buffer
    RELEASED = 5  # session: the receive buffer may be written again
    SEGMENT = 6  # segment: value = size; with the memory, unless it is empty
    CLOSED = 7  # nothing more will come: the side was closed


class Note(NamedTuple):
    """A note and the descriptor that came with it, which the receiver closes."""

    kind: int
    value: int
    descriptor: int | None


_NOTE = struct.Struct("<IIQ")
_NO_ROOM = (errno.EAGAIN, errno.ENOBUFS, errno.ETOOMANYREFS)  # the last: descriptors under way

# Room for some 170 notes that the peer has not taken, and as much again for the last one.
_ROOM_BYTES = 1 << 16

_links: weakref.WeakSet[Link] = weakref.WeakSet()


class Link:
    """One side of the connection; for one thread at a time."""

    def __init__(self, connection: socket.socket, subject: str) -> None:
        connection.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, _ROOM_BYTES)
        self._socket = connection
        self._subject = subject
        self._owner = os.getpid()
        self.is_gone = False
        self.was_closed = False
        _links.add(self)

    @property
    def is_open(self) -> bool:
        """Whether this side was not closed, and is not that of a parent process."""
        return self._socket.fileno() >= 0

    @property
    def descriptors(self) -> list[int]:
        """Descriptors that become readable with a note; none once the peer has gone."""
        return [] if self.is_gone else [self._socket.fileno()]

    def require_open(self) -> None:
        """Raise a TransportError if this side was closed, or belongs to the parent process."""
        if not self.is_open:
            inherited = self._owner != os.getpid()
            text = "belongs to the parent process: open it anew" if inherited else "was closed"
            raise TransportError(f"{self._subject}: this side {text}")

    def require_peer(self) -> None:
        """Raise a PeerGoneError if the other side has ended."""
        if self.is_gone:
            how = "closed its side" if self.was_closed else "ended without closing its side"
            raise PeerGoneError(f"{self._subject}: the other process {how}")

    def tell(self, kind: NoteKind, value: int = 0, descriptor: int | None = None) -> bool:
        """Send a note without blocking; False if there is no room for it in the socket."""
        self.require_peer()
        note = [_NOTE.pack(kind, 0, value)]
        try:
            if descriptor is None:
                self._socket.sendmsg(note)
            else:
                socket.send_fds(self._socket, note, [descriptor])
        except ConnectionError:
            return False  # take_note() reports it, after the peer's earlier notes
        except OSError as error:
            if error.errno not in _NO_ROOM:
                raise
            return False
        return True

    def take_note(self) -> Note | None:
        """Return the next note; None if there is none now, or, with `is_gone` set, never again."""
        while not self.is_gone:
            try:
                note, descriptors, *_ = socket.recv_fds(
                    self._socket, _NOTE.size, 1, socket.MSG_CMSG_CLOEXEC
                )
            except BlockingIOError:
                return None
            except ConnectionResetError:
                continue  # the peer left notes of this side unread; its own are still there
            if not note:
                self._lose()
                return None
            kind, _, value = _NOTE.unpack(note)
            self.was_closed = kind == NoteKind.CLOSED
            return Note(kind, value, descriptors[0] if descriptors else None)
        return None

    def wait(self, deadline: Deadline) -> bool:
        """Sleep until there is a note, or the peer has gone; False after the deadline."""
        return wait_for_any(self.descriptors, deadline)

    def close(self) -> None:
        """Notify the peer that nothing more will come; idempotent."""
        if self.is_open:
            if not self.is_gone:
                self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, 2 * _ROOM_BYTES)
                self.tell(NoteKind.CLOSED)
            self._socket.close()

    def abandon(self) -> None:
        """In a child of fork(): let go of the parent's connection without a word."""
        self._socket.close()

    def _lose(self) -> None:
        self.is_gone = True
        if not self.was_closed:
            remove_names_of_the_dead()


def _abandon_links() -> None:
    """Close inherited sockets: open, they would hide the parent's death from the peers."""
    for link in _links:
        link.abandon()


os.register_at_fork(after_in_child=_abandon_links)
