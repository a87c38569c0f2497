# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""User at the other end of a connection on this machine, as the kernel knows it.

The link with the token is an argument of the browser, which other users see in `ps`: the token
alone does not keep them out.
"""

from __future__ import annotations

import socket
import sys
from contextlib import suppress
from pathlib import Path

Address = tuple[str, int]

# A client may also be an IPv6 socket that is connected to the IPv4 address.
_TABLES = (Path("/proc/net/tcp"), Path("/proc/net/tcp6"))
_LOCAL, _REMOTE, _USER, _INODE = 1, 2, 7, 9  # columns, see proc(5)


def user_of_client(client: Address, server: Address) -> int | None:
    """Return the id of the user whose socket is connected from `client` to `server`.

    None if there is no such socket: a process that has closed it has no user any more.
    """
    ends = (_written(client), _written(server))
    for table in _TABLES:
        with suppress(OSError):  # without IPv6 there is one table
            for line in table.read_text().splitlines()[1:]:
                row = line.split()
                if (row[_LOCAL][-13:], row[_REMOTE][-13:]) == ends and row[_INODE] != "0":
                    return int(row[_USER])
    return None


def _written(address: Address) -> str:
    """Return an IPv4 address and port as the tables have them, IPv6 prefix left out."""
    host, port = address
    number = int.from_bytes(socket.inet_aton(host), sys.byteorder)
    return f"{number:08X}:{port:04X}"
