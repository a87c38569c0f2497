# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Values that programs may assign to sequences of numbers, right and wrong."""

from __future__ import annotations

import array
import collections
import ctypes
import mmap
import tempfile
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

Made = Callable[[], Any]

LENGTHS = (0, 3, 24, 31)  # those below 24 are left to Python
DTYPES = (
    *("i1", "u1", "i2", "u2", "i4", "u4", "i8", "u8", "f2", "f4", "f8", "g", "?", "F", "D"),
    *(
        "longlong",
        "ulonglong",
        ">i2",
        ">u4",
        ">i8",
        ">f4",
        ">f8",
        "O",
        "S3",
        "U3",
        "M8[s]",
        "m8[s]",
    ),
)
# Around the limits of all types; each stands last in an array of small numbers.
EDGES = (
    *(-1, 127, 128, 255, 256, -128, -129, 32767, 32768, 65535, 65536, -32769),
    *(2**31 - 1, 2**31, 2**32 - 1, 2**32, -(2**31) - 1, 2**53 + 1, 2**24 + 1, 2**54 + 2**30 + 1),
    *(2**63 - 1, 2**63, 2**63 + 1025, 2**64 - 1, -(2**63)),
    *(0.5, -0.0, 1e-45, 1e-310, 65504.0, 3.402823466e38, 3.4028235677973366e38, 3.5e38, 1e308),
    *(float("inf"), float("-inf"), float("nan")),
)


class Counting(np.ndarray):
    """Iterates over other elements than its buffer has."""

    def __getitem__(self, index: Any) -> Any:
        if not isinstance(index, int):
            return super().__getitem__(index)
        if index == 30:
            raise IndexError
        return index


class Plain(np.ndarray):
    pass


class OwnArray(array.array):  # type: ignore[type-arg]
    pass


class OwnBytes(bytes):
    def __iter__(self) -> Any:
        return iter([1] * 30)


def small(dtype: str, length: int) -> Any:
    return (np.arange(length) % 100).astype(dtype)


def ending_in(dtype: str, edge: float) -> Any:
    values = small(dtype, 30)
    with np.errstate(all="ignore"):
        values[-1] = np.array(edge).astype(dtype)
    return values


def memory_mapped(dtype: str) -> Any:
    with tempfile.TemporaryFile() as file:
        return np.memmap(file, dtype=dtype, shape=(30,), mode="w+")


def released() -> Any:
    view = memoryview(bytes(30))
    view.release()
    return view


def mapped() -> Any:
    return mmap.mmap(-1, 4096)


def _numpy_values() -> dict[str, Made]:
    made: dict[str, Made] = {}
    for dtype in DTYPES:
        for length in LENGTHS:
            made[f"{dtype} x {length}"] = partial(small, dtype, length)
        for layout, change in {
            "strided": lambda values: values[::2],
            "reversed": lambda values: values[::-1],
            "column": lambda values: values.reshape(-1, 1),
            "matrix": lambda values: values.reshape(6, 10),
            "scalar": lambda values: values[:1].reshape(()),
            "repeated": lambda values: np.broadcast_to(values[1:2], 30),
            "counting": lambda values: values.view(Counting),
            "plain": lambda values: values.view(Plain),
            "masked": lambda values: np.ma.masked_greater(values, 50),
            "memoryview": memoryview,
            "memoryview strided": lambda values: memoryview(values)[::3],
            "memoryview of a matrix": lambda values: memoryview(values.reshape(6, 10)),
        }.items():
            values = small(dtype, 60)
            try:
                change(values)
            except (TypeError, ValueError):
                continue  # no such thing of this dtype
            made[f"{dtype} {layout}"] = partial(change, values)
    for dtype in ("u1", "f4", "f8", "i8"):
        made[f"{dtype} memory-mapped"] = partial(memory_mapped, dtype)
    for dtype in ("i1", "u1", "i2", "u2", "i4", "u4", "i8", "u8", "f2", "f4", "f8", ">f8", ">i8"):
        for edge in EDGES:
            try:
                ending_in(dtype, edge)
            except (OverflowError, ValueError):
                continue
            made[f"{dtype} with {edge}"] = partial(ending_in, dtype, edge)
    made["structured"] = lambda: np.zeros(30, [("x", "u1")])
    made["matrix class"] = lambda: np.matrix([1.0] * 30)
    read_only = small("u1", 30)
    read_only.setflags(write=False)
    made["read-only"] = lambda: read_only
    return made


def _other_values() -> dict[str, Made]:
    made: dict[str, Made] = {}
    for code in "bBhHiIlLqQfd":
        for length in LENGTHS:
            numbers = array.array(code, range(length))
            made[f"array {code} x {length}"] = partial(array.array, code, numbers)
            made[f"memoryview {code} x {length}"] = partial(memoryview, numbers)
            made[f"own array {code} x {length}"] = partial(OwnArray, code, numbers)
        last = array.array(code, [1] * 29 + [200 if code in "BHILQ" else -100])
        made[f"memoryview {code}, limits"] = partial(memoryview, last)
    for code in "c?bHd":
        made[f"bytes cast to {code}"] = lambda code=code: memoryview(bytes(48)).cast(code)
    made["u"] = lambda: array.array("u", "x" * 30)
    made["two dimensions"] = lambda: memoryview(bytes(48)).cast("B", (6, 8))
    made["released"] = released
    made["mmap"] = mapped
    for kind in (ctypes.c_uint8, ctypes.c_int32, ctypes.c_double, ctypes.c_char):
        made[f"ctypes {kind.__name__}"] = lambda kind=kind: (kind * 30)()
    for length in LENGTHS:
        content = bytes(range(length))
        for container in (
            *(bytes, bytearray, list, tuple, set, frozenset, iter, collections.deque, OwnBytes),
            collections.UserList,
        ):
            made[f"{container.__name__} x {length}"] = partial(container, content)
        made[f"floats x {length}"] = lambda length=length: [0.5] * length
        made[f"list of numpy x {length}"] = lambda length=length: list(small("f4", length))
        made[f"range {length}"] = partial(range, length)
    made["one is a string"] = lambda: [1] * 29 + ["a"]
    made["too large"] = lambda: [1] * 29 + [2**70]
    for value in (None, 5, 1.5, "text" * 10, {}, object, True, np.float32(1)):
        made[f"{value!r}"] = lambda value=value: value
    return made


def made_values() -> dict[str, Made]:
    """Return functions that make the values, by name."""
    return {**_numpy_values(), **_other_values()}
