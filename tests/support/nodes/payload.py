# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Messages that detect damage: writer, number, checksum, then random bytes."""

from __future__ import annotations

import random
import struct
import zlib

from std_msgs.msg import UInt8MultiArray

HEADER = struct.Struct("<QQI")
RANDOM_BYTES = random.Random(1).randbytes(1 << 20)


def make_message(writer: int, number: int, size_bytes: int) -> UInt8MultiArray:
    """Return a message with `size_bytes` after its header."""
    start = random.randrange(len(RANDOM_BYTES) - size_bytes + 1)
    body = RANDOM_BYTES[start : start + size_bytes]
    header = HEADER.pack(writer, number, zlib.crc32(body, writer ^ number))
    return UInt8MultiArray(data=header + body)


def read_message(message: UInt8MultiArray) -> tuple[int, int]:
    """Return writer and number; raise a ValueError if the message is torn."""
    data = bytes(message.data)
    writer, number, checksum = HEADER.unpack_from(data)
    if zlib.crc32(data[HEADER.size :], writer ^ number) != checksum:
        damage = _damage(data[HEADER.size :])
        raise ValueError(f"torn message: writer {writer}, number {number}, {damage}")
    return writer, number


def _damage(body: bytes) -> str:
    """Return where the body was overwritten, and with what."""
    start = max(RANDOM_BYTES.find(body[:16]), 0)
    expected = RANDOM_BYTES[start : start + len(body)]
    foreign = [
        i for i, (found, was) in enumerate(zip(body, expected, strict=False)) if found != was
    ]
    if not foreign:
        return f"its header, of {len(body)} bytes"
    first, last = foreign[0], foreign[-1]
    dump = body[first : first + 64].hex()
    return f"{len(foreign)} of {len(body)} bytes, from {first} to {last}: {dump}"
