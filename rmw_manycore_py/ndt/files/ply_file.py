# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Reads and writes positions in PLY files, in the file's precision.

The reader is our own: Open3D's (0.20) invents the points that are missing in a cut file, and mixes
up axes that do not stand in the order x, y, z.
"""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO

import numpy as np
import numpy.typing as npt

from rmw_manycore_py.ndt.files.positions import (
    Column,
    axes_in,
    broken,
    count_in,
    read_data,
    stacked,
    write_binary,
    wrong_word,
)
from rmw_manycore_py.ndt.geometry.arrays import Points

NUMBERS = {
    **dict.fromkeys(("char", "int8"), "i1"),
    **dict.fromkeys(("uchar", "uint8"), "u1"),
    **dict.fromkeys(("short", "int16"), "i2"),
    **dict.fromkeys(("ushort", "uint16"), "u2"),
    **dict.fromkeys(("int", "int32"), "i4"),
    **dict.fromkeys(("uint", "uint32"), "u4"),
    **dict.fromkeys(("float", "float32"), "f4"),
    **dict.fromkeys(("double", "float64"), "f8"),
}
ORDERS = {"ascii": "=", "binary_little_endian": "<", "binary_big_endian": ">"}
MAX_HEADER_BYTES = 100_000
HEADER = """ply
format binary_little_endian 1.0
element vertex {points}
property {kind} x
property {kind} y
property {kind} z
end_header
"""


@dataclass
class _Element:
    """An element of the header; a list has the type of its length before that of its items."""

    name: str
    count: int
    properties: list[tuple[str, tuple[str, ...]]] = field(default_factory=list)

    @property
    def has_lists(self) -> bool:
        return any(len(kinds) > 1 for _, kinds in self.properties)


@dataclass
class _Header:
    encoding: str
    elements: list[_Element]  # up to the points

    @property
    def points(self) -> _Element:
        return self.elements[-1]


def read_ply(path: Path) -> Points:
    """Return the positions (N, 3), including non-finite ones; raises OSError and ValueError."""
    with path.open("rb") as file:
        header = _read_header(file)
        properties = header.points.properties
        axes = axes_in([name for name, _ in properties])
        if header.points.has_lists:
            raise ValueError("it is broken: its points have lists")
        read = _ascii if header.encoding == "ascii" else _binary
        columns = read(file, header, axes)
    return stacked(columns, is_single=all(properties[axis][1] == ("f4",) for axis in axes))


def _read_header(file: IO[bytes]) -> _Header:
    """Read a header, up to the first byte of the data."""
    words = _header_words(file)
    encoding, elements = "", list[_Element]()
    try:
        if next(words) != "ply":
            raise broken("it does not begin with ply")
        for word in words:
            if word == "format":
                encoding, _ = next(words), next(words)
            elif word == "element":
                elements.append(_Element(next(words), count_in(next(words), "a count")))
            elif word == "property" and elements:
                kinds = [next(words)]
                if kinds == ["list"]:
                    kinds = [next(words), next(words)]
                elements[-1].properties.append((next(words), tuple(map(_number, kinds))))
            else:
                raise broken(f"expected an element or a property, found '{word[:40]}'")
    except StopIteration:
        raise broken("it ends early") from None
    if encoding not in ORDERS:
        raise broken(f"the format is none of {', '.join(ORDERS)}")
    names = [element.name for element in elements]
    if "vertex" not in names:
        raise ValueError("it has no points: its header has no element vertex")
    return _Header(encoding, elements[: names.index("vertex") + 1])


def _header_words(file: IO[bytes]) -> Iterator[str]:
    while (line := file.readline(MAX_HEADER_BYTES)) and file.tell() <= MAX_HEADER_BYTES:
        at = 0
        while at < len(line) and (rest := line[at:].split(maxsplit=1)):
            word = rest[0]
            at = line.index(word, at) + len(word)
            if word in (b"comment", b"obj_info"):
                break
            if word == b"end_header":
                if line[at:].strip():  # all of a text file on one line
                    file.seek(at - len(line), os.SEEK_CUR)
                return
            yield word.decode("ascii", "replace")
    raise ValueError("it has no points: its header has no end_header")


def _number(word: str) -> str:
    if word not in NUMBERS:
        raise broken(f"the type '{word[:40]}' is unknown")
    return NUMBERS[word]


def _ascii(file: IO[bytes], header: _Header, axes: list[int]) -> list[Column]:
    begin = file.tell()
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # of numpy before 2.3, for words that are not numbers
        try:
            found = np.fromstring(file.read().decode("ascii"), sep=" ")
        except (DeprecationWarning, ValueError) as error:
            unknown = "it is broken: a word among its points is no number"
            raise ValueError(wrong_word(file, begin) or unknown) from error
    at = 0
    for element in header.elements[:-1]:
        at = _after(element, found, at)
    columns = len(header.points.properties)
    needed, left = header.points.count * columns, max(len(found) - at, 0)
    if left < needed:
        raise ValueError(f"its {header.points.count} points need {needed} numbers, found {left}")
    table = found[at : at + needed].reshape(-1, columns)
    return [table[:, axis] for axis in axes]


def _after(element: _Element, numbers: npt.NDArray[np.float64], at: int) -> int:
    """Return the index of the first number after an element."""
    if not element.has_lists:
        return at + element.count * len(element.properties)
    for _ in range(element.count):
        for _, kinds in element.properties:
            at += 1 + (_length(numbers[at]) if len(kinds) > 1 else 0)
    return at


def _length(number: float) -> int:
    if number < 0:
        raise ValueError("it is broken: the length of a list is negative")
    return int(number)


def _binary(file: IO[bytes], header: _Header, axes: list[int]) -> list[Column]:
    order = ORDERS[header.encoding]
    for element in header.elements[:-1]:
        _skip(file, element, order)
    kinds = [f"{order}{kind}" for _, (kind,) in header.points.properties]
    record = np.dtype([(str(at), kind) for at, kind in enumerate(kinds)])
    count = header.points.count
    records = np.frombuffer(read_data(file, count, count * record.itemsize), record)
    return [records[str(axis)] for axis in axes]


def _skip(file: IO[bytes], element: _Element, order: str) -> None:
    """Skip an element of a binary file."""
    sizes = [np.dtype(kinds[-1]).itemsize for _, kinds in element.properties]
    if not element.has_lists:
        file.seek(sum(sizes) * element.count, os.SEEK_CUR)
        return
    for _ in range(element.count):
        for size, (_, kinds) in zip(sizes, element.properties, strict=True):
            length = 1
            if len(kinds) > 1:
                kind = np.dtype(f"{order}{kinds[0]}")
                data = read_data(file, element.count, kind.itemsize)
                length = _length(np.frombuffer(data, kind)[0])
            file.seek(size * length, os.SEEK_CUR)


def write_ply(path: Path, points: Points) -> None:
    """Write positions (N, 3) in their own precision, as a binary file."""
    kind = "float" if points.dtype == np.float32 else "double"
    header = HEADER.format(points=len(points), kind=kind)
    write_binary(path, header, points)
