# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The datagrams that Linux dropped as a socket's receive buffer was full, from /proc.

They are parts of messages. What of it DDS asks for again and gets is no loss; for a best-effort
message a part is as much as the whole.
"""

from __future__ import annotations

import os
from pathlib import Path

_INODE, _DROPS = 9, 12  # columns of /proc/net/udp
_PREFIX, _SUFFIX = "socket:[", "]"


def socket_drops(pid: int, proc: Path = Path("/proc")) -> int | None:
    """Return how many datagrams a process's present UDP sockets have lost; None if it is gone."""
    try:
        own = _sockets(proc / str(pid) / "fd")
        rows = [
            row.split()
            for name in ("udp", "udp6")
            for row in _lines(proc / str(pid) / "net" / name)[1:]
        ]
    except OSError:
        return None
    return sum(int(row[_DROPS]) for row in rows if row[_INODE] in own)


def receive_buffer_errors(pid: int, proc: Path = Path("/proc")) -> int | None:
    """Return how many datagrams all sockets of a process's network namespace have lost."""
    try:
        lines = [line.split() for line in _lines(proc / str(pid) / "net" / "snmp")]
    except OSError:
        return None
    names, values = (line for line in lines if line[0] == "Udp:")
    return int(values[names.index("RcvbufErrors")])


def _sockets(directory: Path) -> set[str]:
    """Return the inodes of the sockets that a process has open."""
    found = set()
    for entry in os.scandir(directory):
        try:
            target = os.readlink(entry.path)
        except FileNotFoundError:  # closed meanwhile
            continue
        if target.startswith(_PREFIX):
            found.add(target.removeprefix(_PREFIX).removesuffix(_SUFFIX))
    return found


def _lines(file: Path) -> list[str]:
    try:
        return file.read_text().splitlines()
    except FileNotFoundError:
        if file.name == "udp6":  # Linux without IPv6
            return []
        raise
