# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Messages as packets of one page each, which a pipe takes and gives whole."""

from __future__ import annotations

import mmap
import struct
from collections.abc import Iterator
from typing import Any, NamedTuple, TypeAlias, cast

from numpy.typing import NDArray
from typing_extensions import Buffer

from rmw_manycore_py.transport.arguments import checked_number
from rmw_manycore_py.transport.errors import refusal

# What can be sent; to type checkers numpy arrays are buffers from Python 3.12 on.
Data: TypeAlias = "Buffer | NDArray[Any]"

PRIORITIES = 8
ALL_PRIORITIES = (1 << PRIORITIES) - 1
"""The mask of all priorities."""
# A page is a slot of a pipe: with full pages, free slots can be counted.
PACKET_BYTES = mmap.PAGESIZE
# Number of the message; its size; where this packet's part begins; length of the part; synchronous.
_HEAD = struct.Struct("<QQQII")
BODY_BYTES = PACKET_BYTES - _HEAD.size
_PADDING = memoryview(bytes(BODY_BYTES))


class Message(NamedTuple):
    """A message that was received."""

    priority: int
    """0 to 7, the highest first."""
    data: bytes
    """A copy of what was sent."""


class Packet(NamedTuple):
    """A part of a message."""

    number: int
    size: int
    offset: int
    is_synchronous: bool
    body: memoryview


def mask_of(*priorities: int) -> int:
    """Return the mask of some priorities: bit p is set for priority p.

    :raises TransportError: if one is not from 0 to 7.
    """
    mask = 0
    for priority in priorities:
        mask |= 1 << checked_number("priority", priority, 0, PRIORITIES - 1)
    return mask


def bytes_of(data: Data) -> memoryview:
    """Return what an object's buffer holds, without a copy.

    :raises TransportError: if it has no buffer, or its elements do not lie one after the other.
    """
    try:
        view = memoryview(cast(Buffer, data))
    except (TypeError, ValueError):  # ValueError: of dates
        expected = "bytes, a numpy array of numbers or another buffer"
        raise refusal("data", expected, type(data).__name__) from None
    if not view.c_contiguous:
        raise refusal(
            "data", "elements one after the other (numpy.ascontiguousarray)", view.strides
        )
    return view.cast("B") if view.nbytes else memoryview(b"")


def packet_count(size_bytes: int) -> int:
    """Return the number of packets of a message; an empty one has one."""
    return max(1, -(-size_bytes // BODY_BYTES))


def packets_of(data: memoryview, number: int, is_synchronous: bool) -> Iterator[list[Buffer]]:
    """Yield a message as packets: head, body and padding, to be written in one go."""
    for offset in range(0, max(1, len(data)), BODY_BYTES):
        body = data[offset : offset + BODY_BYTES]
        head = _HEAD.pack(number, len(data), offset, len(body), is_synchronous)
        yield [head, body, _PADDING[len(body) :]]


def parsed(packet: bytes) -> Packet:
    """Return the fields of a packet."""
    number, size, offset, length, is_synchronous = _HEAD.unpack_from(packet)
    body = memoryview(packet)[_HEAD.size : _HEAD.size + length]
    return Packet(number, size, offset, bool(is_synchronous), body)
