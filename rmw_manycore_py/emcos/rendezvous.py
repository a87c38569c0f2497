# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""How the two sides of a transfer find each other, in either order.

Each tries to bind an abstract socket address made from the name. The first one listens, the second
one finds the address in use and connects. The kernel frees the address with its process. Both send
a hello; a peer that ends before it has sent one does not count, and the search goes on.
"""

from __future__ import annotations

import errno
import hashlib
import os
import socket
import struct
import time

from rmw_manycore_py.emcos.waiting import wait_for_any
from rmw_manycore_py.native import _transport
from rmw_manycore_py.transport.arguments import Deadline
from rmw_manycore_py.transport.errors import TransportError

# The other side is between bind() and listen(), or has not accepted an earlier connection yet.
_PAUSE_S = 0.002
_HELLO_BYTES = 256
_CREDENTIALS = struct.Struct("3i")  # struct ucred: pid, uid, gid


def meet(platform: str, name: str, hello: bytes, deadline: Deadline) -> tuple[socket.socket, bytes]:
    """Return a connection to the other side, and its hello.

    :raises TimeoutError: if it has not come by the deadline.
    :raises TransportError: if another user holds the address.
    """
    address = _address(platform, name)
    while True:
        connection = _accepted(address, deadline) or _connected(address)
        if connection is None:
            _pause(deadline)
            continue
        try:
            if theirs := _greet(connection, hello, deadline):
                return connection, theirs
        except BaseException:
            connection.close()
            raise
        connection.close()


def _address(platform: str, name: str) -> bytes:
    """Return an abstract address, which all processes of a network namespace share.

    It stands for the directory that holds the platforms, however its path is written, and the
    names, which may be longer than addresses.
    """
    directory = os.stat(_transport.platforms_place())
    key = f"{directory.st_dev}:{directory.st_ino}/{platform}/{name}"
    digest = hashlib.sha256(key.encode()).hexdigest()[:32]
    return f"\0manycore-emcos-{os.geteuid()}-{digest}".encode()


def _socket() -> socket.socket:
    found = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    found.setblocking(False)
    return found


def _accepted(address: bytes, deadline: Deadline) -> socket.socket | None:
    """Return the first connection of this user; None if the address is in use."""
    with _socket() as listener:
        try:
            listener.bind(address)
        except OSError as error:
            if error.errno == errno.EADDRINUSE:
                return None
            raise
        listener.listen(1)
        while wait_for_any([listener.fileno()], deadline):
            connection, _ = listener.accept()
            connection.setblocking(False)
            if _user_of(connection) == os.geteuid():
                return connection
            connection.close()
    raise TimeoutError


def _connected(address: bytes) -> socket.socket | None:
    """Return a connection to the listener; None if it does not listen any more, or not yet."""
    connection = _socket()
    try:
        connection.connect(address)
    except (ConnectionRefusedError, BlockingIOError):
        connection.close()
        return None
    except BaseException:
        connection.close()
        raise
    if (user := _user_of(connection)) != os.geteuid():
        connection.close()
        raise TransportError(f"its address is held by a process of user {user}; end that process")
    return connection


def _user_of(connection: socket.socket) -> int:
    credentials = connection.getsockopt(socket.SOL_SOCKET, socket.SO_PEERCRED, _CREDENTIALS.size)
    return int(_CREDENTIALS.unpack(credentials)[1])


def _greet(connection: socket.socket, hello: bytes, deadline: Deadline) -> bytes:
    """Exchange hellos; empty if the other side has ended, or gave its place to another one."""
    try:
        connection.send(hello)
        if not wait_for_any([connection.fileno()], deadline):
            raise TimeoutError
        return connection.recv(_HELLO_BYTES)
    except ConnectionError:
        return b""


def _pause(deadline: Deadline) -> None:
    left_s = deadline.left_s()
    if left_s == 0:
        raise TimeoutError
    time.sleep(_PAUSE_S if left_s is None else min(_PAUSE_S, left_s))
