# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What rosbridge, rosboard and programs with OpenCV do with arrays of messages gives the same for
arrays in a record, and leaves these as they were."""

from __future__ import annotations

import array
import base64
import ctypes
import hashlib
import io
import json
import struct
import zlib
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from support import IS_MANYCORE
from support.nodes.exchanging import Exchange, in_record, large

pytestmark = pytest.mark.skipif(not IS_MANYCORE, reason="others copy")

Conversion = Callable[[Any], Any]


def packed(data: Any) -> bytes:
    return struct.pack(f"<{len(data)}{data.typecode}", *data)


def written(data: Any) -> bytes:
    file = io.BytesIO()
    file.write(data)
    return file.getvalue()


def over_memory(data: Any) -> bytes:
    """Convert as cv_bridge does."""
    values: Any = np.ndarray(shape=(len(data) // 4, 4), dtype=data.typecode, buffer=data)
    return values[::2, ::-1].tobytes()


def swapped(data: Any) -> Any:
    other = data[:]
    other.byteswap()
    return other


def from_ctypes(data: Any) -> bytes:
    kind = ctypes.c_double if data.typecode == "d" else ctypes.c_uint8
    return bytes((kind * len(data)).from_buffer(data))


CONVERSIONS: dict[str, Conversion] = {
    "rosbridge base64": lambda data: base64.standard_b64encode(data).decode("ascii"),
    "rosbridge list types": lambda data: type(data) in [list, tuple, np.ndarray, array.array],
    "rosbridge list": list,
    "rosbridge BSON": bytes,
    "rosbridge CBOR": packed,
    "rosboard array types": lambda data: type(data) in (np.ndarray, array.array),
    "rosboard list": lambda data: data.tolist(),
    "rosboard JPEG": lambda data: base64.b64encode(bytearray(data)).decode(),
    "rosboard points": lambda data: np.frombuffer(data, "<u4").view(np.recarray).tobytes(),
    "rosboard grid": lambda data: np.array(data, dtype=np.float32).reshape(2, -1)[::-1].tobytes(),
    "cv_bridge": over_memory,
    "cv_bridge, other byte order": swapped,
    "cv2.imdecode": lambda data: np.asarray(bytearray(data), dtype=np.uint8).tobytes(),
    "JSON": lambda data: json.dumps(list(data)),
    "file": written,
    "socket": lambda data: b"".join([memoryview(data).cast("B")[:1000], memoryview(data)[1000:]]),
    "checksum": lambda data: (zlib.crc32(data), hashlib.sha256(data).hexdigest()),
    "ctypes": from_ctypes,
    "iteration": lambda data: (max(data), min(reversed(data)), sum(data)),
    "slice": lambda data: data[10:-10:3],
}


@pytest.fixture(params="Bd")
def taken(node: Any, request: pytest.FixtureRequest) -> tuple[Any, Any]:
    """Return an array in a record, and the same values as array.array."""
    values = large(request.param)
    found = Exchange(node, typecode=request.param)(values)
    assert in_record(found)
    return found, values


def test_conversions_give_what_they_give_with_copies(taken: tuple[Any, Any]) -> None:
    found, values = taken
    for name, convert in CONVERSIONS.items():
        assert convert(found) == convert(values), name
    assert found == values


def test_conversions_of_copies_do_not_change_the_record(taken: tuple[Any, Any]) -> None:
    found, values = taken
    for change in (bytearray, np.array, lambda data: data[:], lambda data: data.tolist()):
        changed = change(found)
        changed[0] = changed[1]
        assert found == values
