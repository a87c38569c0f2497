# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Arrays as messages; tests/integration/test_transport.py compares with what ROS nodes write."""

from __future__ import annotations

import struct
from typing import Any

import numpy as np
import pytest

from rmw_manycore_py.transport import TransportError
from rmw_manycore_py.transport.multi_array import (
    TYPES,
    checked_dtype,
    head_of,
    layout_of,
    room_for,
)

pytestmark = pytest.mark.unit

SHAPES = [(5,), (2, 3), (0,), (4, 0, 3), (1, 2, 3, 4)]


def message_of(array: np.ndarray) -> bytes:
    return head_of(array.shape, array.itemsize) + array.tobytes()


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("dtype", TYPES, ids=str)
def test_what_is_written_is_read(dtype: np.dtype, shape: tuple[int, ...]) -> None:
    array = np.arange(np.prod(shape), dtype=dtype).reshape(shape)
    message = message_of(array)
    layout = layout_of(message, len(message), dtype.itemsize)
    assert (layout.shape, layout.size, layout.is_little_endian) == (shape, array.size, True)
    read = np.frombuffer(message[layout.offset_bytes :], dtype).reshape(shape)
    assert np.array_equal(read, array)


def test_elements_of_up_to_four_bytes_are_aligned() -> None:
    for dimensions in range(1, 5):
        assert len(head_of((1,) * dimensions, 4)) % 16 == 0


def big_endian(values: list[float], sizes: list[int]) -> bytes:
    dimensions = b"".join(struct.pack(">I4xII", 1, size, size) for size in sizes)
    head = struct.pack(">HHI", 0, 0, len(sizes)) + dimensions
    return head + struct.pack(f">II{len(values)}f", 0, len(values), *values)


def test_another_byte_order_is_read() -> None:
    message = big_endian([1.5, 2.5], [2])
    layout = layout_of(message, len(message), 4)
    assert (layout.shape, layout.is_little_endian) == ((2,), False)
    assert np.frombuffer(message[layout.offset_bytes :], ">f4").tolist() == [1.5, 2.5]


def test_labels_of_any_length_are_skipped() -> None:
    for label in (b"\0", b"x\0", b"row\0", b"columns\0"):
        padded = label + bytes(-len(label) % 4)
        head = struct.pack("<4xII", 1, len(label)) + padded + struct.pack("<IIII", 2, 2, 0, 2)
        message = b"\0\1\0\0" + head[4:] + b"ab"
        assert layout_of(message, len(message), 1)[:3] == ((2,), 2, len(message) - 2)


def test_a_message_without_dimensions_has_one() -> None:
    message = b"\0\1\0\0" + struct.pack("<III", 0, 0, 3) + bytes(12)
    assert layout_of(message, len(message), 4).shape == (3,)


MALFORMED = {
    "nothing": (b"", "it ends after 0 bytes"),
    "no head": (b"\0\1\0\0", "it ends after 4 bytes"),
    "encapsulation": (b"\0\7\0\0" + bytes(12), "its encapsulation is 0007"),
    "too few elements": (b"\0\1\0\0" + struct.pack("<III", 0, 0, 9), "9 elements of 4 bytes"),
    "endless dimensions": (b"\0\1\0\0\xff\xff\xff\xff", "4294967295 dimensions"),
    "endless label": (b"\0\1\0\0\1\0\0\0\xff\xff\xff\xff", "it ends after 12 bytes"),
    "other count": (
        b"\0\1\0\0" + struct.pack("<II4xIIII", 1, 1, 3, 3, 0, 1) + bytes(4),
        r"dimensions \(3,\) do not make up its 1 elements",
    ),
    "huge and empty": (
        b"\0\1\0\0" + struct.pack("<I", 5) + 4 * struct.pack("<I4xII", 1, 1 << 31, 0)
        + struct.pack("<I4xIIII", 1, 0, 0, 0, 0),
        "do not make up",
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", MALFORMED)
def test_what_is_no_array_is_refused(name: str) -> None:
    message, problem = MALFORMED[name]
    with pytest.raises(TransportError, match=problem):
        layout_of(message, len(message), 4)


@pytest.mark.parametrize(
    "dtype",
    [None, "float16", "complex64", bool, object, "U5", ">f4", "no such type", [("x", "f4")]],
)
def test_a_type_without_a_message_is_refused(dtype: object) -> None:
    with pytest.raises(TransportError, match=r"dtype: expected one of int8, .* float64, found"):
        checked_dtype(dtype)


def test_a_number_is_no_array() -> None:
    with pytest.raises(TransportError, match="1 to 32 dimensions"):
        head_of((), 8)


@pytest.mark.parametrize("shape", [-1, (1, -1), (), (1.5,), 1 << 40])
def test_room_is_lent_for_shapes_that_a_message_can_have(shape: Any) -> None:
    with pytest.raises(TransportError):
        room_for(shape, 1)
