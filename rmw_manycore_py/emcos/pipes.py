# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The pipe of one priority: its content lies in the kernel, with neither process."""

from __future__ import annotations

import fcntl
import os
import struct
import termios
from collections.abc import Sequence
from contextlib import suppress

from typing_extensions import Buffer

from rmw_manycore_py.emcos.packets import PACKET_BYTES, Packet, parsed

# The kernel's limit for unprivileged users, and what the pipes of a platform have.
_CAPACITY_BYTES = 1 << 20


def create_pipe() -> tuple[int, int]:
    """Return read and write end of a new pipe; neither blocks."""
    ends = os.pipe2(os.O_NONBLOCK | os.O_CLOEXEC)
    with suppress(PermissionError):  # the pages of this user's pipes are limited: it stays small
        fcntl.fcntl(ends[1], fcntl.F_SETPIPE_SZ, _CAPACITY_BYTES)
    return ends


class PipeWriter:
    """The write end; the only one."""

    def __init__(self, descriptor: int) -> None:
        self.descriptor = descriptor
        self.capacity = fcntl.fcntl(descriptor, fcntl.F_GETPIPE_SZ) // PACKET_BYTES

    def room(self) -> int:
        """Return the number of packets that can be written now; only this process lowers it."""
        unread = fcntl.ioctl(self.descriptor, termios.FIONREAD, bytes(4))
        return self.capacity - int(struct.unpack("i", unread)[0]) // PACKET_BYTES

    def try_write(self, packet: Sequence[Buffer]) -> bool:
        """Write a packet; False if the pipe is full, or its reader has gone."""
        try:
            os.writev(self.descriptor, packet)
        except (BlockingIOError, BrokenPipeError):
            return False
        return True

    def close(self) -> None:
        """Close the end."""
        os.close(self.descriptor)


class PipeReader:
    """The read end; the only one."""

    def __init__(self, descriptor: int) -> None:
        self.descriptor = descriptor

    def try_read(self) -> Packet | None:
        """Read a packet; None if there is none."""
        try:
            packet = os.read(self.descriptor, PACKET_BYTES)
        except BlockingIOError:
            return None
        return parsed(packet) if packet else None

    def close(self) -> None:
        """Close the end."""
        os.close(self.descriptor)
