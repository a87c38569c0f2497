# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Datagrams dropped by Linux because a socket's receive buffer was full, from /proc.

A datagram is a fragment of a message. Reliable DDS readers request it again; a best-effort message
is lost with its first missing fragment.
"""

from __future__ import annotations

import os
from pathlib import Path

_INODE, _DROPS = 9, 12  # columns of /proc/net/udp
_PREFIX, _SUFFIX = "socket:[", "]"


def socket_drops(pid: int, proc: Path = Path("/proc")) -> int | None:
    """Return the drops of a process's open UDP sockets; None if the process has ended."""
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
    """Return the drops of all sockets in a process's network namespace."""
    try:
        lines = [line.split() for line in _lines(proc / str(pid) / "net" / "snmp")]
    except OSError:
        return None
    names, values = (line for line in lines if line[0] == "Udp:")
    return int(values[names.index("RcvbufErrors")])


def _sockets(directory: Path) -> set[str]:
    """Return the inodes of the sockets a process has open."""
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
