# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Encodes Perfetto's track events in bulk: columns of numbers, laid out by numpy.

Numbers are varints padded to a fixed length, so that each part of a packet is a row of a table.
Protobuf permits this; Perfetto itself pads lengths in this way.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Bytes = NDArray[np.uint8]  # one row per packet with the part
Rows = NDArray[np.intp]  # ascending

_TIME_BYTES = 9
_LENGTH_BYTES = 3
_ID_BYTES = 4
_NUMBER_BYTES = 10
_PIECE = 100_000  # rows processed at a time

# Protobuf field tags: number * 8 + wire type.
_PACKET = b"\x0a"  # of message Trace
_SEQUENCE, _NEEDS_STATE = b"\x50\x01", b"\x68\x02"  # of message TracePacket: fields 10 and 13
_TIMESTAMP, _TRACK_EVENT = b"\x40", b"\x5a"  # fields 8 and 11
_TYPE, _TRACK, _NAME = b"\x48", b"\x58", b"\x50"  # of message TrackEvent: fields 9, 11, 10
_COUNTER_VALUE = b"\xe1\x02"  # field 44, a double
_FLOW, _LAST_OF_FLOW = b"\xf9\x02", b"\x81\x03"  # fields 47 and 48, fixed64
_ANNOTATION = 4  # field of message TrackEvent
_ANNOTATION_NAME, _UINT_VALUE, _STRING_VALUE = 10, b"\x18", 6  # of message DebugAnnotation

SLICE_BEGIN, SLICE_END, INSTANT, COUNTER = 1, 2, 3, 4  # TrackEvent.Type


class Part(NamedTuple):
    """Part of some packets' track events; a packet may have several of one kind."""

    rows: Rows
    data: Bytes


def varint(numbers: NDArray[Any], length: int) -> Bytes:
    """Return a row of `length` bytes per number."""
    left = np.asarray(numbers).astype(np.uint64)
    out = np.empty((len(left), length), np.uint8)
    for i in range(length):
        out[:, i] = left.astype(np.uint8) & 0x7F | (0x80 if i < length - 1 else 0)
        left >>= np.uint64(7)
    return out


def field(number: int, data: bytes) -> bytes:
    """Return a length-delimited field."""
    return _short(number << 3 | 2) + _short(len(data)) + data


def _short(number: int) -> bytes:
    out = bytearray()
    while number > 0x7F:
        out.append(number & 0x7F | 0x80)
        number >>= 7
    return bytes((*out, number))


def name(rows: Rows, ids: NDArray[Any]) -> Part:
    """Return the interned name ids of slices."""
    return Part(rows, _columns(len(rows), _NAME, varint(ids, _ID_BYTES)))


def number(rows: Rows, key: str, values: NDArray[Any]) -> Part:
    """Return a numeric argument of slices."""
    head = field(_ANNOTATION_NAME, key.encode()) + _UINT_VALUE
    tag = _short(_ANNOTATION << 3 | 2) + _short(len(head) + _NUMBER_BYTES)
    return Part(rows, _columns(len(rows), tag + head, varint(values, _NUMBER_BYTES)))


def word(rows: Rows, key: str, value: str) -> Part:
    """Return a string argument, equal for all slices."""
    text = field(_ANNOTATION_NAME, key.encode()) + field(_STRING_VALUE, value.encode())
    return Part(rows, _columns(len(rows), field(_ANNOTATION, text)))


def flow(rows: Rows, ids: NDArray[Any], *, is_last: bool) -> Part:
    """Return the flows that pass through slices, or end there."""
    return Part(rows, _columns(len(rows), _LAST_OF_FLOW if is_last else _FLOW, _fixed(ids, "<u8")))


def value(values: NDArray[Any]) -> Part:
    """Return counter values."""
    return Part(
        np.arange(len(values)), _columns(len(values), _COUNTER_VALUE, _fixed(values, "<f8"))
    )


def track_events(
    track: int, types: NDArray[Any], times_ns: NDArray[Any], parts: Sequence[Part]
) -> bytes:
    """Return the packets of a track: one per type and time, with its parts."""
    count = len(types)
    if not count:
        return b""
    event = _columns(
        count, _TYPE, types.astype(np.uint8)[:, None], _TRACK,
        varint(np.full(count, track), _ID_BYTES),
    )  # fmt: skip
    lengths = np.full(count, event.shape[1])
    for part in parts:
        lengths += np.bincount(part.rows, minlength=count) * part.data.shape[1]
    inside = _columns(
        count, _SEQUENCE, _NEEDS_STATE, _TIMESTAMP, varint(times_ns, _TIME_BYTES),
        _TRACK_EVENT, varint(lengths, _LENGTH_BYTES),
    )  # fmt: skip
    outside = _columns(count, _PACKET, varint(inside.shape[1] + lengths, _LENGTH_BYTES))
    head = np.concatenate([outside, inside, event], axis=1)
    return _laid_out(count, [Part(np.arange(count), head), *parts])


def _columns(count: int, *columns: bytes | Bytes) -> Bytes:
    """Return columns side by side; `bytes` are repeated in each row."""
    return np.concatenate(
        [
            np.broadcast_to(np.frombuffer(column, np.uint8), (count, len(column)))
            if isinstance(column, bytes)
            else column
            for column in columns
        ],
        axis=1,
    )


def _fixed(values: NDArray[Any], kind: str) -> Bytes:
    return np.ascontiguousarray(values, kind).view(np.uint8).reshape(-1, 8)


def _laid_out(count: int, parts: Sequence[Part]) -> bytes:
    """Return the concatenated parts of each row."""
    widths = [np.bincount(part.rows, minlength=count) * part.data.shape[1] for part in parts]
    ends = np.cumsum(np.sum(widths, axis=0))
    out = np.empty(int(ends[-1]), np.uint8)
    begins = ends - np.sum(widths, axis=0)
    for part, width in zip(parts, widths, strict=True):
        rank = np.arange(len(part.rows)) - np.searchsorted(part.rows, part.rows)
        places = begins[part.rows] + rank * part.data.shape[1]
        columns = np.arange(part.data.shape[1])
        for first in range(0, len(places), _PIECE):
            piece = slice(first, first + _PIECE)
            out[places[piece, None] + columns] = part.data[piece]
        begins += width
    return out.tobytes()
