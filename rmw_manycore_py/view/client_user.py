# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""User at the other end of a connection on this machine, as the kernel knows it.

The link with the token is an argument of the browser, which other users see in `ps`: the token
alone does not keep them out.
"""

from __future__ import annotations

import asyncio
import socket
import sys
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from weakref import WeakKeyDictionary

Address = tuple[str, int]

_TABLE = Path("/proc/net/tcp")
_TABLE_IPV6 = Path("/proc/net/tcp6")
_LOCAL, _REMOTE, _USER, _INODE = 1, 2, 7, 9  # columns, see proc(5)


class ClientUsers:
    """Users at the other ends of connections, each looked up once: the tables may be long."""

    def __init__(self) -> None:
        self._known: WeakKeyDictionary[asyncio.BaseTransport, int] = WeakKeyDictionary()

    def of(self, connection: asyncio.BaseTransport | None) -> int | None:
        """Return the id of the user; None if the kernel does not know it any more.

        :raises OSError: if the tables cannot be read.
        """
        if connection is None:
            return None
        user = self._known.get(connection)
        if user is None:
            ends = [connection.get_extra_info(end) for end in ("peername", "sockname")]
            user = None if None in ends else user_of_client(*ends)
        if user is not None:
            self._known[connection] = user
        return user


def user_of_client(client: Address, server: Address) -> int | None:
    """Return the id of the user whose socket is connected from `client` to `server`.

    None if there is no such socket: a process that has closed it has no user any more.

    :raises OSError: if the tables cannot be read.
    """
    ends = (_written(client), _written(server))
    for _ in range(2):  # a table that changes while it is read may lack a row
        for row in _rows():
            if (row[_LOCAL][-13:], row[_REMOTE][-13:]) == ends and row[_INODE] != "0":
                return int(row[_USER])
    return None


def _rows() -> Iterator[list[str]]:
    yield from _rows_of(_TABLE)
    # A client may also be an IPv6 socket that is connected to the IPv4 address.
    with suppress(FileNotFoundError):  # a kernel without IPv6
        yield from _rows_of(_TABLE_IPV6)


def _rows_of(table: Path) -> Iterator[list[str]]:
    return map(str.split, table.read_text().splitlines()[1:])


def _written(address: Address) -> str:
    """Return an IPv4 address and port as the tables have them, IPv6 prefix left out."""
    host, port = address
    number = int.from_bytes(socket.inet_aton(host), sys.byteorder)
    return f"{number:08X}:{port:04X}"
