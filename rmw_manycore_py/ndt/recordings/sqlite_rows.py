# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Rows of a SQLite file whose end is missing, page by page.

SQLite finds rows through pages near the end of the file, so it reads nothing of a cut one. The
format: https://www.sqlite.org/fileformat.html.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from mmap import ACCESS_READ, mmap
from typing import IO, NamedTuple

_BEGIN = b"SQLite format 3\0"
_FIRST_HEADER = 100  # bytes of the file's header, on page 1
_LEAF = 13  # type of pages with rows of tables
_SIZES = (0, 1, 2, 3, 4, 6, 8, 8, 0, 0)  # bytes of a column, by its serial type below 12
_FIRST_BLOB = 12  # even types from here on; texts have odd ones

Value = int | bytes | None


class Row(NamedTuple):
    """A row and its place, for SqlitePages.values()."""

    number: int
    values: Sequence[Value]
    place: tuple[int, int]  # offsets of its page in the file, and of the row in the page


class SqlitePages:
    """The pages of a file, which is mapped."""

    def __init__(self, file: IO[bytes]) -> None:
        """Map a file; raise ValueError if it is not a SQLite file."""
        self._content = mmap(file.fileno(), 0, access=ACCESS_READ)  # an empty one: ValueError
        header = self._content[:_FIRST_HEADER]
        if len(header) < _FIRST_HEADER or not header.startswith(_BEGIN):
            raise ValueError("no SQLite file")
        size = int.from_bytes(header[16:18], "big")
        self._size = 65536 if size == 1 else size
        self._usable = self._size - header[20]
        if self._size < 512 or self._usable < 480:
            raise ValueError("a damaged SQLite file")

    def rows(self, columns: int) -> Iterator[Row]:
        """Yield the complete rows of all tables with this number of columns."""
        for start in range(0, len(self._content) - self._size + 1, self._size):
            page = self._content[start : start + self._size]
            head = _FIRST_HEADER if start == 0 else 0
            if page[head] != _LEAF:
                continue
            for at in range(int.from_bytes(page[head + 3 : head + 5], "big")):
                pointer = head + 8 + 2 * at
                place = start, int.from_bytes(page[pointer : pointer + 2], "big")
                try:
                    number, payload = self._cell(page, place[1])
                    values = _values(payload)
                except (IndexError, ValueError):
                    continue
                if len(values) == columns:
                    yield Row(number, values, place)

    def values(self, place: tuple[int, int]) -> Sequence[Value]:
        """Read the values of a row again."""
        page = self._content[place[0] : place[0] + self._size]
        return _values(self._cell(page, place[1])[1])

    def close(self) -> None:
        """Unmap the file."""
        self._content.close()

    def _cell(self, page: bytes, at: int) -> tuple[int, bytes]:
        """Return row id and payload of a cell; the payload may continue in other pages."""
        size, at = _varint(page, at)
        row, at = _varint(page, at)
        local = self._local(size)
        parts = [page[at : at + local]]
        left = size - local
        following = int.from_bytes(page[at + local : at + local + 4], "big") if left else 0
        while left > 0:
            start = (following - 1) * self._size
            more = self._content[start : start + self._usable] if following > 0 else b""
            if len(more) < self._usable:
                raise ValueError("the row continues after the end")
            parts.append(more[4 : 4 + left])
            left -= self._usable - 4
            following = int.from_bytes(more[:4], "big")
        return row, b"".join(parts)

    def _local(self, size: int) -> int:
        """Return how many bytes of a payload are in its cell."""
        if size <= self._usable - 35:
            return size
        minimum = (self._usable - 12) * 32 // 255 - 23
        local = minimum + (size - minimum) % (self._usable - 4)
        return local if local <= self._usable - 35 else minimum


def _varint(data: bytes, at: int) -> tuple[int, int]:
    """Return a number and the offset after it."""
    value = 0
    for index in range(8):
        byte = data[at + index]
        value = value << 7 | byte & 0x7F
        if byte < 0x80:
            return value, at + index + 1
    return value << 8 | data[at + 8], at + 9


def _values(payload: bytes) -> list[Value]:
    """Return the columns of a row; texts as bytes."""
    end, at = _varint(payload, 0)
    place, values = end, list[Value]()
    while at < end:
        kind, at = _varint(payload, at)
        size = (kind - _FIRST_BLOB) // 2 if kind >= _FIRST_BLOB else _SIZES[kind]
        content = payload[place : place + size]
        if len(content) < size:
            raise ValueError("the row is cut")
        place += size
        if kind >= _FIRST_BLOB:
            values.append(content)
        elif kind == 0:
            values.append(None)
        else:
            values.append(int.from_bytes(content, "big", signed=True) if size else kind - 8)
    return values
