# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Positions in PCD files (PCL's format, version 0.7), in the precision that the file has.

Not by Open3D: of binary files, one of its readers (0.20) takes doubles for singles, the other is
led astray by the padding fields that PCL writes.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from rmw_manycore_py.ndt.lzf import decompress
from rmw_manycore_py.ndt.thinning import Points

NUMBER_KINDS = {"F": "f", "I": "i", "U": "u"}
AXES = ("x", "y", "z")
LONGEST_HEADER = 100_000  # bytes


@dataclass(frozen=True)
class Field:
    """A field of a point: `count` numbers."""

    name: str
    number: np.dtype[np.generic]
    count: int


@dataclass(frozen=True)
class Header:
    """What stands before the data, and at which byte those begin."""

    fields: tuple[Field, ...]
    points: int
    encoding: str
    end: int

    @property
    def point_bytes(self) -> int:
        """Return the size of a point."""
        return sum(field.count * field.number.itemsize for field in self.fields)


def read_pcd(path: Path) -> Points:
    """Return the positions (N, 3) of a file, finite or not; raises OSError and ValueError."""
    raw = path.read_bytes()
    header = _header(raw)
    if header.encoding == "ascii":
        return _of_text(header, raw)
    if header.encoding == "binary":
        return _of_records(header, memoryview(raw)[header.end :])
    if header.encoding == "binary_compressed":
        return _of_columns(header, _inflated(raw[header.end :]))
    raise ValueError(f"DATA is {header.encoding}, expected ascii, binary or binary_compressed")


def write_pcd(path: Path, points: Points) -> None:
    """Write positions (N, 3), in the precision that they have, as a binary file."""
    size = points.dtype.itemsize
    header = (
        "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z\n"
        f"SIZE {size} {size} {size}\nTYPE F F F\nCOUNT 1 1 1\nWIDTH {len(points)}\nHEIGHT 1\n"
        f"VIEWPOINT 0 0 0 1 0 0 0\nPOINTS {len(points)}\nDATA binary\n"
    )
    path.write_bytes(header.encode() + np.ascontiguousarray(points).tobytes())


def _header(raw: bytes) -> Header:
    entries: dict[str, list[str]] = {}
    end = 0
    while "DATA" not in entries:
        begin, end = end, raw.find(b"\n", end, LONGEST_HEADER) + 1
        if end == 0:
            raise ValueError("it has no header with FIELDS, SIZE, TYPE and DATA")
        key, *words = raw[begin:end].decode("ascii", "replace").split() or [""]
        entries[key] = words
    try:
        fields, points, encoding = _fields(entries), _point_count(entries), entries["DATA"][0]
    except (KeyError, IndexError, ValueError) as error:
        raise ValueError(f"its header is broken: {error!r}") from error
    if points < 0 or any(field.count < 0 for field in fields):
        raise ValueError("its header is broken: a number of points or of values is negative")
    return Header(fields, points, encoding, end)


def _fields(entries: dict[str, list[str]]) -> tuple[Field, ...]:
    names = entries["FIELDS"]
    kinds = [NUMBER_KINDS[kind] for kind in entries["TYPE"]]
    counts = map(int, entries.get("COUNT", ["1"] * len(names)))
    try:
        return tuple(
            Field(name, np.dtype(f"<{kind}{size}"), count)
            for name, kind, size, count in zip(names, kinds, entries["SIZE"], counts, strict=True)
        )
    except TypeError as error:  # numpy's, of a size that no number has
        raise ValueError(str(error)) from error


def _point_count(entries: dict[str, list[str]]) -> int:
    if "POINTS" in entries:
        return int(entries["POINTS"][0])
    return int(entries["WIDTH"][0]) * int(entries["HEIGHT"][0])


def _places(header: Header) -> list[int]:
    """Return which of the fields are x, y and z."""
    names = [field.name for field in header.fields]
    missing = [axis for axis in AXES if axis not in names]
    if missing:
        raise ValueError(f"it has no field {', '.join(missing)}; its fields: {' '.join(names)}")
    return [names.index(axis) for axis in AXES]


def _of_text(header: Header, raw: bytes) -> Points:
    begins = np.cumsum([0, *(field.count for field in header.fields)])
    columns = [int(begins[place]) for place in _places(header)]
    lines = raw[header.end :].decode("ascii", "replace").splitlines()[: header.points]
    _check_size(header, len(lines), header.points, "lines")
    if not lines:
        return np.zeros((0, 3))
    return np.loadtxt(lines, np.float64, comments=None, usecols=columns, ndmin=2)


def _of_records(header: Header, data: memoryview) -> Points:
    places = _places(header)
    _check_size(header, len(data), header.points * header.point_bytes, "bytes")
    begins = np.cumsum([0, *(f.count * f.number.itemsize for f in header.fields)])
    steps = (header.point_bytes,)
    return _stacked(
        [
            np.ndarray((header.points,), header.fields[i].number, data, int(begins[i]), steps)
            for i in places
        ]
    )


def _of_columns(header: Header, data: bytes) -> Points:
    """Return positions of data that have one field of all points after the other."""
    _check_size(header, len(data), header.points * header.point_bytes, "bytes")
    sizes = [header.points * field.count * field.number.itemsize for field in header.fields]
    begins = np.cumsum([0, *sizes])
    return _stacked(
        [
            np.frombuffer(data, header.fields[i].number, header.points, int(begins[i]))
            for i in _places(header)
        ]
    )


def _inflated(data: bytes) -> bytes:
    if len(data) < 8:
        raise ValueError("its data are cut off")
    packed, unpacked = (int.from_bytes(data[at : at + 4], "little") for at in (0, 4))
    return decompress(data[8 : 8 + packed], unpacked)


def _stacked(axes: list[npt.NDArray[np.generic]]) -> Points:
    is_single = all(axis.dtype == np.float32 for axis in axes)
    return np.stack(axes, axis=1).astype(np.float32 if is_single else np.float64, copy=False)


def _check_size(header: Header, found: int, needed: int, what: str) -> None:
    if found < needed:
        raise ValueError(f"{header.points} points need {needed} {what}, found {found}")
