# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Reads and writes positions in PCD files, in the file's precision.

The reader is our own: of Open3D's (0.20) readers of binary files, one reads doubles as singles, the
other fails on the padding fields that PCL writes; pypcd4 (1.5) takes only files as PCL writes them
today, and does not validate their headers.
"""

from __future__ import annotations

import struct
import warnings
from pathlib import Path
from typing import IO

import numpy as np

from rmw_manycore_py.errors.missing_library import LZF, require
from rmw_manycore_py.ndt.files.pcd_header import PADDING, PcdHeader, read_header
from rmw_manycore_py.ndt.files.positions import (
    Column,
    axes_in,
    read_data,
    stacked,
    write_binary,
    wrong_word,
)
from rmw_manycore_py.ndt.geometry.arrays import Points

HEADER = """VERSION 0.7
FIELDS x y z
SIZE {size} {size} {size}
TYPE F F F
COUNT 1 1 1
WIDTH {points}
HEIGHT 1
VIEWPOINT 0 0 0 1 0 0 0
POINTS {points}
DATA binary
"""
_NO_COLUMNS = [np.zeros(0)] * 3
# LZF replaces at most 264 bytes by 3.
MAX_RATIO = 88


def read_pcd(path: Path) -> Points:
    """Return the positions (N, 3), including non-finite ones; raises OSError and ValueError."""
    with path.open("rb") as file:
        header = read_header(file)
        axes = axes_in([field.name for field in header.fields])
        numbers = {header.fields[axis].number for axis in axes}
        has_points = header.points > 0
        columns = _READERS[header.encoding](file, header, axes) if has_points else _NO_COLUMNS
    return stacked(columns, is_single=numbers == {np.dtype(np.float32)})


def _ascii(file: IO[bytes], header: PcdHeader, axes: list[int]) -> list[Column]:
    begin = file.tell()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of no data at all
        try:
            table = np.loadtxt(file, comments=None, max_rows=header.points, ndmin=2)
        except ValueError as error:
            other = "expected a line of numbers for each of its points"
            raise ValueError(wrong_word(file, begin) or other) from error
    if table.shape[0] < header.points:
        raise ValueError(f"its {header.points} points need as many lines, found {table.shape[0]}")
    if table.shape[1] != header.point_numbers:
        raise ValueError(f"its points need {header.point_numbers} numbers, found {table.shape[1]}")
    firsts = np.cumsum([0, *(field.count for field in header.fields)])
    return [table[:, firsts[axis]] for axis in axes]


def _binary(file: IO[bytes], header: PcdHeader, axes: list[int]) -> list[Column]:
    data = read_data(file, header.points, header.points * header.point_bytes)
    firsts = np.cumsum([0, *(field.bytes for field in header.fields)])
    shape, strides = (header.points,), (header.point_bytes,)
    return [
        np.ndarray(shape, header.fields[axis].number, data, int(firsts[axis]), strides)
        for axis in axes
    ]


def _compressed(file: IO[bytes], header: PcdHeader, axes: list[int]) -> list[Column]:
    """Return columns of a file that has one field of all points after the other."""
    packed_bytes, unpacked_bytes = struct.unpack("<II", read_data(file, header.points, 8))
    packed = read_data(file, header.points, packed_bytes)
    # PCL leaves padding out, others do not.
    sizes = [field.bytes * header.points for field in header.fields]
    bare = [0 if f.name == PADDING else s for f, s in zip(header.fields, sizes, strict=True)]
    sizes = bare if unpacked_bytes == sum(bare) else sizes
    if unpacked_bytes < sum(sizes) or unpacked_bytes > MAX_RATIO * packed_bytes:
        raise ValueError(
            f"its {header.points} points need {sum(sizes)} bytes, found {unpacked_bytes} in "
            f"{packed_bytes} compressed ones"
        )
    data = require(LZF).decompress(packed, unpacked_bytes) if unpacked_bytes else b""
    if data is None or len(data) != unpacked_bytes:
        raise ValueError("it is broken: its data cannot be decompressed")
    firsts = np.cumsum([0, *sizes])
    return [
        np.frombuffer(data, header.fields[axis].number, header.points, int(firsts[axis]))
        for axis in axes
    ]


_READERS = {"ascii": _ascii, "binary": _binary, "binary_compressed": _compressed}


def write_pcd(path: Path, points: Points) -> None:
    """Write positions (N, 3) in their own precision, as a binary file."""
    header = HEADER.format(size=points.dtype.itemsize, points=len(points))
    write_binary(path, header, points)
