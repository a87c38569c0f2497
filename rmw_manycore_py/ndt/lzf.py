# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""LZF, the compression of PCD files, in the direction that is needed here.

A control byte below 32 announces one literal byte more than its value. Else its upper three bits
are the length of a repetition less 2 (7: a further byte is added to it), its lower five and the
next byte the distance less 1 at which that began.
"""

from __future__ import annotations

LITERAL = 32
LONG = 7


def decompress(data: bytes, size: int) -> bytes:
    """Return `size` bytes; raises ValueError where the data do not give as many."""
    out = bytearray()
    at = 0
    try:
        while at < len(data):
            control = data[at]
            at += 1
            if control < LITERAL:
                out += data[at : at + control + 1]
                at += control + 1
                continue
            length = control >> 5
            if length == LONG:
                length += data[at]
                at += 1
            _repeat(out, ((control & 31) << 8) + data[at] + 1, length + 2)
            at += 1
    except IndexError as error:
        raise ValueError("the compressed data are cut off") from error
    if len(out) != size:
        raise ValueError(f"the compressed data give {len(out)} bytes, expected {size}")
    return bytes(out)


def _repeat(out: bytearray, distance: int, length: int) -> None:
    """Append what began `distance` bytes ago, which may reach into what is appended."""
    begin = len(out) - distance
    if begin < 0:
        raise ValueError("the compressed data point before their beginning")
    if length <= distance:
        out += out[begin : begin + length]
    else:
        out += (out[begin:] * (length // distance + 1))[:length]
