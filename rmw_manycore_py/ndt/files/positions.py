# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Rules that PCD and PLY files share: axes, precision, counts, and sizes of data."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import IO, Any, TypeAlias

import numpy as np
import numpy.typing as npt

from rmw_manycore_py.ndt.geometry.arrays import Points

Column: TypeAlias = npt.NDArray[Any]  # (N,)
_AXES = ("x", "y", "z")
_MAX_DIGITS = 18  # such a count fits into 64 bits


def axes_in(names: Sequence[str]) -> list[int]:
    """Return the indices of x, y and z; raise ValueError if one is missing."""
    missing = [axis for axis in _AXES if axis not in names]
    if missing:
        raise ValueError(f"it has no field {', '.join(missing)}")
    return [names.index(axis) for axis in _AXES]


def stacked(columns: Sequence[Column], *, is_single: bool) -> Points:
    """Return the columns of the axes as points (N, 3), in single or double precision."""
    with np.errstate(invalid="ignore"):  # signalling nan
        points: Points = np.stack(columns, axis=1).astype(np.float32 if is_single else np.float64)
    return points


def read_data(file: IO[bytes], points: int, size_bytes: int) -> bytes:
    """Read the data of the points; raise ValueError if the file ends before."""
    # Before anything is allocated: the size may be an invention of a damaged header.
    left_bytes = max(os.fstat(file.fileno()).st_size - file.tell(), 0)
    if left_bytes < size_bytes:
        raise ValueError(f"its {points} points need {size_bytes} bytes, found {left_bytes}")
    return file.read(size_bytes)


def write_binary(path: Path, header: str, points: Points) -> None:
    """Write a header and points (N, 3) in their own precision."""
    path.write_bytes(header.encode() + points.astype(points.dtype.newbyteorder("<")).tobytes())


def count_in(word: str, what: str) -> int:
    """Return a count of a header; raise ValueError, which names `what`, if it is none."""
    digits = word.removeprefix("-")
    if not digits.isdecimal():
        raise broken(f"{what} is not a number: '{word[:40]}'")
    if digits != word:
        raise broken(f"{what} is negative: {word[:40]}")
    if len(word) > _MAX_DIGITS:
        raise broken(f"{what} is too large: {word[:40]}")
    return int(word)


def wrong_word(file: IO[bytes], begin: int) -> str:
    """Return the first word from an offset on that is no number, and its line; "" if none is."""
    file.seek(0)
    first = 1 + file.read(begin).count(b"\n")
    for number, line in enumerate(file, first):
        for word in line.split():
            try:
                float(word)
            except ValueError:
                return f"expected numbers in line {number}, found '{_text(word)}'"
    return ""


def _text(word: bytes) -> str:
    return word[:40].decode("ascii", "replace")


def broken(problem: str) -> ValueError:
    """Return the error for a header."""
    return ValueError(f"its header is broken: {problem}")
