# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Checks for a network interface; without one, Fast DDS fails silently."""

from __future__ import annotations

import fcntl
import socket
import struct

_SIOCGIFFLAGS = 0x8913  # netdevice(7)
_IFF_UP = 1
_NAME_BYTES, _IFREQ_BYTES = 16, 40


def has_interface() -> bool:
    """Return whether any network interface is up, including loopback."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        return any(_is_up(probe, name) for _, name in socket.if_nameindex())


def _is_up(probe: socket.socket, name: str) -> bool:
    request = name.encode().ljust(_IFREQ_BYTES, b"\0")
    try:
        answer = fcntl.ioctl(probe, _SIOCGIFFLAGS, request)
    except OSError:  # the interface was removed meanwhile
        return False
    return bool(struct.unpack_from("H", answer, _NAME_BYTES)[0] & _IFF_UP)
