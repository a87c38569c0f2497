# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Arrays as messages: std_msgs/msg/Float32MultiArray and its nine sisters, in CDR.

```
 0   encapsulation: 00 01 00 00 (CDR, little endian)
 4   number of dimensions, then for each: label "" (4 + 1 bytes, 3 of padding), size, stride
     data_offset = 0, number of elements, 4 bytes of padding before elements of 8 bytes
 N   the elements, in C order
```

N is a multiple of 16, and 4 more for elements of 8 bytes: CDR aligns them to the byte behind the
encapsulation.
"""

from __future__ import annotations

import functools
import math
import operator
import struct
from collections.abc import Sequence
from typing import Any, NamedTuple, TypeVar

import numpy as np
from typing_extensions import Buffer

from rmw_manycore_py.transport.errors import TransportError, refusal

Scalar = TypeVar("Scalar", bound=np.number[Any])

_KINDS = ("Int8", "Int16", "Int32", "Int64", "UInt8", "UInt16", "UInt32", "UInt64")
TYPES: dict[np.dtype[Any], str] = {
    np.dtype(kind.lower()): f"std_msgs/msg/{kind}MultiArray"
    for kind in (*_KINDS, "Float32", "Float64")
}
_ENCAPSULATION_BYTES = 4
_LITTLE_ENDIAN, _BIG_ENDIAN = b"\0\1", b"\0\0"
_EMPTY_LABEL = struct.Struct("<I4x")
_DIMENSION = struct.Struct("<II")
_TAIL = struct.Struct("<II")
# A record's size has 32 bits.
MAX_MESSAGE_BYTES = (1 << 32) - 1
MAX_DIMENSIONS = 32


class Room(NamedTuple):
    """What a message needs."""

    shape: tuple[int, ...]
    head: bytes
    body_bytes: int


class Layout(NamedTuple):
    """Position and layout of the elements in a message."""

    shape: tuple[int, ...]
    size: int
    offset_bytes: int
    is_little_endian: bool


def checked_dtype(dtype: Any) -> np.dtype[Any]:
    """Return the element type, which must have a message type in ROS 2.

    :raises TransportError: if it has none.
    """
    try:
        known: np.dtype[Any] = np.dtype(dtype)
    except TypeError:
        known = np.dtype(object)
    if dtype is None or known not in TYPES:
        names = ", ".join(str(one) for one in TYPES)
        raise refusal("dtype", f"one of {names}", repr(dtype))
    return known


def checked_shape(shape: Any) -> tuple[int, ...]:
    """Return a shape as numpy has it: an integer is one dimension.

    :raises TransportError: if a size is no integer, or negative.
    """
    try:
        sizes = tuple(operator.index(size) for size in np.atleast_1d(np.asarray(shape)).tolist())
    except (TypeError, ValueError):
        sizes = (-1,)
    if min(sizes, default=0) < 0:
        raise refusal("shape", "an integer, or a tuple of integers, from 0", repr(shape))
    return sizes


def head_of(shape: tuple[int, ...], itemsize: int) -> bytes:
    """Return the bytes of an array's message before its elements.

    :raises TransportError: if no message can hold an array of this shape.
    """
    count = math.prod(shape)
    if not 1 <= len(shape) <= MAX_DIMENSIONS:
        raise refusal("array", f"1 to {MAX_DIMENSIONS} dimensions", f"shape {shape}")
    if count * itemsize > MAX_MESSAGE_BYTES - 1024 or max(shape) > MAX_MESSAGE_BYTES:
        raise refusal("array", "less than 4 GiB", f"{count * itemsize} bytes in shape {shape}")
    parts = [_LITTLE_ENDIAN + b"\0\0", struct.pack("<I", len(shape))]
    for axis, size in enumerate(shape):
        stride = min(math.prod(shape[axis:]), MAX_MESSAGE_BYTES)
        parts += [_EMPTY_LABEL.pack(1), _DIMENSION.pack(size, stride)]
    parts.append(_TAIL.pack(0, count))
    if itemsize == 8 and count:
        parts.append(b"\0\0\0\0")
    return b"".join(parts)


@functools.lru_cache(maxsize=64, typed=True)
def room_for(shape: int | tuple[int, ...], itemsize: int) -> Room:
    """Return the room of an array's message; as `checked_shape` and `head_of`."""
    sizes = checked_shape(shape)
    return Room(sizes, head_of(sizes, itemsize), math.prod(sizes) * itemsize)


def layout_of(message: Buffer, size_bytes: int, itemsize: int) -> Layout:
    """Read the head of a message.

    A message without dimensions, as many ROS nodes publish, is read as one-dimensional.

    :raises TransportError: if it is not an array of such elements, or its dimensions do not match
        the number of elements.
    """
    try:
        return _read(message, size_bytes, itemsize)
    except struct.error as error:
        raise _malformed(f"it ends after {size_bytes} bytes") from error


def _read(message: Buffer, size_bytes: int, itemsize: int) -> Layout:
    encapsulation = bytes(struct.unpack_from("2s2x", message)[0])
    if encapsulation not in (_LITTLE_ENDIAN, _BIG_ENDIAN):
        raise _malformed(f"its encapsulation is {encapsulation.hex()}, not CDR")
    order = "<" if encapsulation == _LITTLE_ENDIAN else ">"
    word, two_words = struct.Struct(f"{order}I"), struct.Struct(f"{order}II")
    (dimensions,) = word.unpack_from(message, _ENCAPSULATION_BYTES)
    if dimensions > MAX_DIMENSIONS:
        raise _malformed(f"it has {dimensions} dimensions, at most {MAX_DIMENSIONS} can be read")
    at = _ENCAPSULATION_BYTES + 4
    sizes = []
    for _ in range(dimensions):
        (label_bytes,) = word.unpack_from(message, at)
        at = _aligned(at + 4 + label_bytes, 4)
        sizes.append(two_words.unpack_from(message, at)[0])
        at += 8
    _, count = two_words.unpack_from(message, at)
    at += 8
    at = _aligned(at, itemsize) if count else at
    if at + count * itemsize > size_bytes:
        raise _malformed(f"{count} elements of {itemsize} bytes are not in {size_bytes} bytes")
    return Layout(_shape(sizes, count), count, at, order == "<")


def _shape(sizes: Sequence[int], count: int) -> tuple[int, ...]:
    if not sizes:
        return (count,)
    if math.prod(sizes) != count or math.prod(filter(None, sizes)) > MAX_MESSAGE_BYTES:
        raise _malformed(f"its dimensions {tuple(sizes)} do not make up its {count} elements")
    return tuple(sizes)


def _aligned(at: int, alignment: int) -> int:
    """Return the next position whose distance from the encapsulation's end is a multiple."""
    return at + (_ENCAPSULATION_BYTES - at) % alignment


def _malformed(why: str) -> TransportError:
    return TransportError(f"the message is no array: {why}")
