# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Messages that detect damage: writer and number, then bytes that follow from both."""

from __future__ import annotations

import random
import struct
from typing import Any

from std_msgs.msg import UInt8MultiArray

HEADER = struct.Struct("<QQ")
RANDOM_BYTES = random.Random(1).randbytes(1 << 20)


def make_message(writer: int, number: int, size_bytes: int) -> UInt8MultiArray:
    """Return a message with `size_bytes` after its header."""
    return UInt8MultiArray(data=make_bytes(writer, number, size_bytes))


def make_bytes(writer: int, number: int, size_bytes: int) -> bytes:
    """Return what a message holds that has `size_bytes` after its header."""
    start = _start(writer, number, size_bytes)
    return HEADER.pack(writer, number) + RANDOM_BYTES[start : start + size_bytes]


def read_message(message: Any) -> tuple[int, int]:
    """Return writer and number; raise a ValueError if the message is torn."""
    data = memoryview(message.data)
    writer, number = HEADER.unpack_from(data)
    body = data[HEADER.size :]
    start = _start(writer, number, len(body))
    if not RANDOM_BYTES.startswith(body, start):  # a memcmp: elements of views compare slowly
        damage = _damage(bytes(body), start)
        raise ValueError(f"torn message: writer {writer}, number {number}, {damage}")
    return writer, number


def _start(writer: int, number: int, size_bytes: int) -> int:
    """Return where the bytes of a message lie in the random ones: all messages differ."""
    return hash((writer, number)) % (len(RANDOM_BYTES) - size_bytes + 1)


def _damage(body: bytes, start: int) -> str:
    """Return where the body was overwritten, and with what."""
    expected = RANDOM_BYTES[start : start + len(body)]
    foreign = [i for i, (found, was) in enumerate(zip(body, expected, strict=True)) if found != was]
    first, last = foreign[0], foreign[-1]
    dump = body[first : first + 64].hex()
    return f"{len(foreign)} of {len(body)} bytes, from {first} to {last}: {dump}"
