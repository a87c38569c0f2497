# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The header of a PCD file, by the rules of PCL's reader (`pcl::PCDReader::readHeader`).

Only the beginning of a line's first word counts; the version is ignored. Files before version 0.7
have no SIZE, TYPE and COUNT: each field is one float32. A field with COUNT 0 is left out.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import IO

import numpy as np

from rmw_manycore_py.ndt.files.positions import broken, count_in

KEYWORDS = (
    *("VERSION", "FIELDS", "COLUMNS", "SIZE", "TYPE", "COUNT", "WIDTH", "HEIGHT", "VIEWPOINT"),
    *("POINTS", "DATA"),
)
ENCODINGS = ("binary_compressed", "binary", "ascii")
PADDING = "_"
MAX_LINE_BYTES = 1_000_000
_SINGLE = "f4"
_LETTERS = {"F": "f", "I": "i", "U": "u"}
_NUMBERS = ("f4", "f8", "i1", "i2", "i4", "i8", "u1", "u2", "u4", "u8")


@dataclass(frozen=True)
class Field:
    """One field of the points."""

    name: str
    size: int  # bytes of a number
    kind: str  # as numpy names it, if there is such a type
    count: int

    @property
    def bytes(self) -> int:
        """Return its bytes in a point."""
        return self.size * self.count

    @property
    def number(self) -> np.dtype[np.generic]:
        """Return the type of its numbers; raise ValueError if there is no such type."""
        if self.kind not in _NUMBERS:
            raise broken(f"the field {self.name} has an unknown TYPE, or an unknown SIZE for it")
        return np.dtype(f"<{self.kind}")


@dataclass(frozen=True)
class PcdHeader:
    """Layout of the points that follow the header."""

    fields: tuple[Field, ...]
    points: int
    encoding: str

    @property
    def point_bytes(self) -> int:
        """Return the bytes of a point."""
        return sum(field.bytes for field in self.fields)

    @property
    def point_numbers(self) -> int:
        """Return the count of numbers in a point."""
        return sum(field.count for field in self.fields)


def read_header(file: IO[bytes]) -> PcdHeader:
    """Read a header up to the first byte of the data; raise ValueError if it is broken."""
    entries: dict[str, list[str]] = {}
    for keyword, words in _lines(file):
        if keyword in ("TYPE", "COUNT") and "SIZE" not in entries:
            raise broken(f"{keyword} before SIZE")
        if keyword == "COUNT" and "TYPE" not in entries:
            raise broken("COUNT before TYPE")
        entries["FIELDS" if keyword == "COLUMNS" else keyword] = words
    fields = _fields(entries)
    encoding = next((e for e in ENCODINGS if "".join(entries["DATA"][:1]).startswith(e)), "")
    if not encoding:
        raise broken(f"DATA is none of {', '.join(ENCODINGS)}")
    return PcdHeader(fields, _points(entries), encoding)


def _lines(file: IO[bytes]) -> Iterator[tuple[str, list[str]]]:
    """Yield the lines up to DATA: keyword and words."""
    while line := file.readline(MAX_LINE_BYTES):
        words = line.decode("utf-8", "replace").split()
        if not words or words[0].startswith("#"):
            continue
        keyword = next((word for word in KEYWORDS if words[0].startswith(word)), "")
        if not keyword:
            raise broken(f"expected one of {', '.join(KEYWORDS)}, found '{words[0][:40]}'")
        yield keyword, words[1:]
        if keyword == "DATA":
            return
    raise broken("it has no line DATA")


def _fields(entries: dict[str, list[str]]) -> tuple[Field, ...]:
    names = entries.get("FIELDS", [])
    sizes = _numbers(entries, "SIZE", names, 4)
    counts = _numbers(entries, "COUNT", names, 1)
    kinds = [_SINGLE] * len(names)  # without TYPE also where SIZE is larger
    if "TYPE" in entries:
        _check_length(entries, "TYPE", names)
        words = zip(entries["TYPE"], sizes, strict=True)
        kinds = [f"{_LETTERS.get(word[0].upper(), '')}{size}" for word, size in words]
    fields = map(Field, names, sizes, kinds, counts)
    return tuple(field for field in fields if field.count)


def _numbers(
    entries: dict[str, list[str]], keyword: str, names: Sequence[str], default: int
) -> list[int]:
    if keyword not in entries:
        return [default] * len(names)
    _check_length(entries, keyword, names)
    return [count_in(word, keyword) for word in entries[keyword]]


def _check_length(entries: dict[str, list[str]], keyword: str, names: Sequence[str]) -> None:
    if len(entries[keyword]) != len(names):
        raise broken(f"{len(names)} FIELDS, but {len(entries[keyword])} of {keyword}")


def _points(entries: dict[str, list[str]]) -> int:
    """Return the number of points; WIDTH and HEIGHT may be missing in old files."""
    known = {
        keyword: count_in("".join(entries[keyword][:1]), keyword)
        for keyword in ("WIDTH", "HEIGHT", "POINTS")
        if keyword in entries
    }
    points = known.get("POINTS", 0)
    height = known.get("HEIGHT", 1)
    width = known.get("WIDTH", 0) or (0 if "HEIGHT" in known else points)
    if width * height != points:
        raise broken(f"WIDTH {width} and HEIGHT {height} do not give {points} POINTS")
    return points
