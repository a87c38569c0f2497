# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""PCD files made at random, in the variety that PCL reads; some with a flaw."""

from __future__ import annotations

import random
import struct
from dataclasses import dataclass

FLAW = 0.03  # chance of one where there can be one
_FORMATS = {
    ("F", 4): "<f", ("F", 8): "<d", ("I", 1): "<b", ("I", 2): "<h", ("I", 4): "<i",
    ("U", 1): "<B", ("U", 2): "<H", ("U", 4): "<I",
}  # fmt: skip
_OTHERS = ("intensity", "rgb", "ring", "normal", "_", "t")


@dataclass(frozen=True)
class Made:
    """A file; PCL `invents` points for some broken ones."""

    content: bytes
    invents: bool = False


@dataclass
class _Field:
    name: str
    type: str
    size: int
    count: int

    def values(self, chance: random.Random) -> list[float]:
        return [self._value(chance) for _ in range(self.count)]

    def _value(self, chance: random.Random) -> float:
        if self.type == "F":
            odd = (float("nan"), float("inf"), 1e10, -0.125)
            return chance.choice(odd) if chance.random() < 0.05 else chance.randrange(-800, 800) / 8
        return chance.randrange(100)

    def packed(self, values: list[float]) -> bytes:
        if self.name == "_":
            return b"\x55" * (self.size * self.count)
        form = _FORMATS[self.type, self.size]
        return b"".join(struct.pack(form, value) for value in values)


class _Cloud:
    def __init__(self, number: int) -> None:
        self.chance = random.Random(number)
        self.invents = self.has_points = False
        self.points = self.chance.choice((0, 1, 2, 3, 7, 20))
        self.encoding = self.chance.choice(("ascii", "binary", "binary_compressed"))
        self.is_old = self.chance.random() < 0.15  # neither SIZE nor TYPE
        self.has_counts = not self.is_old and self.chance.random() < 0.8
        self.fields = self._fields()
        self.rows = [
            [field.values(self.chance) for field in self.fields] for _ in range(self.points)
        ]

    def flaw(self) -> bool:
        return self.chance.random() < FLAW

    def _fields(self) -> list[_Field]:
        chance = self.chance
        kinds = [("F", 4)] if chance.random() < 0.6 else list(_FORMATS)
        fields = [_Field(axis, *self._kind(kinds), 1) for axis in "xyz"]
        for name in chance.sample(_OTHERS, chance.choice((0, 0, 1, 2, 4))):
            if name == "_" and self.encoding != "binary":
                continue  # PCL writes padding only there
            kind = ("U", chance.choice((1, 3, 4, 13))) if name == "_" else self._kind()
            count = chance.choice((0, 1, 1, 2, 3)) if self.has_counts else 1
            fields.insert(chance.randrange(len(fields) + 1), _Field(name, *kind, count))
        if self.flaw():
            fields.pop(chance.randrange(len(fields)))
        return fields

    def _kind(self, kinds: list[tuple[str, int]] | None = None) -> tuple[str, int]:
        return ("F", 4) if self.is_old else self.chance.choice(kinds or list(_FORMATS))

    def header(self) -> bytes:
        chance = self.chance
        lines = ["# .PCD v.7 - Point Cloud Data file format"] if chance.random() < 0.7 else []
        lines += [f"VERSION {chance.choice(('.7', '0.7', '.5', '0.6', '.6', '1'))}"] * (
            chance.random() < 0.9
        )
        lines.append(self._line("COLUMNS" if chance.random() < 0.1 else "FIELDS", "name"))
        if not self.is_old:
            lines.append(self._line("SIZE", "size"))
            lines.append(self._line("TYPE", "type"))
        if self.has_counts:
            lines.append(self._line("COUNT", "count"))
        lines += self._extent()
        space, end = chance.choice((" ", " ", "\t", "  ", " \t ")), chance.choice(("\n", "\r\n"))
        if self.flaw():  # a line with a CR alone ends the header for PCL
            more = chance.choice(("", "# comment", "#") if end == "\n" else ("# comment", "#"))
            lines.insert(chance.randrange(len(lines)), more)
        if self.flaw():
            lines.insert(
                chance.randrange(len(lines)), chance.choice(("UNITS m", "xyz", "fields x"))
            )
            self.invents = True
        lines.append(f"DATA {self._data()}")
        return "".join(line.replace(" ", space) + end for line in lines).encode()

    def _line(self, keyword: str, attribute: str) -> str:
        words = [str(getattr(field, attribute)) for field in self.fields]
        if attribute == "type":
            words = [w.lower() if self.chance.random() < 0.2 else w for w in words]
            axes = [at for at, field in enumerate(self.fields) if field.name in "xyz"]
            if self.flaw() and axes:
                words[self.chance.choice(axes)] = "X"
                self.invents = True
        if self.flaw() and not self.is_old:
            words.pop()
        return f"{keyword} {' '.join(words)}"

    def _extent(self) -> list[str]:
        chance = self.chance
        height = chance.choice([n for n in (1, 1, 2, 3, 5) if self.points % n == 0])
        width = self.points // height + self.flaw()
        lines = [f"WIDTH {width}", f"HEIGHT {height}"]
        if chance.random() < 0.2:
            lines.append("VIEWPOINT 1 2 3 1 0 0 0")
        self.has_points = not self.flaw()
        if self.has_points:
            lines.append(f"POINTS {self.points}")
        if chance.random() < 0.15:
            lines.pop(chance.randrange(2))
        if chance.random() < 0.05:
            lines = lines[-1:]
        return lines

    def _data(self) -> str:
        if self.flaw():
            self.invents = True
            return self.chance.choice(("BINARY", "text", "zip"))
        return self.encoding

    def body(self) -> bytes:
        if self.encoding == "ascii":
            return self._text()
        rows = [
            [field.packed(values) for field, values in zip(self.fields, row, strict=True)]
            for row in self.rows
        ]
        if self.encoding == "binary":
            data = b"".join(b"".join(row) for row in rows)
        else:
            data = _lzf(b"".join(row[at] for at in range(len(self.fields)) for row in rows))
        if self.flaw() and self.points:
            return data[: self.chance.randrange(len(data))]
        return data + b"\n" * (self.chance.random() < 0.1)

    def _text(self) -> bytes:
        chance, lines = self.chance, []
        end = chance.choice(("\n", "\r\n", " \n"))
        space = chance.choice((" ", " ", "\t", "  "))
        for row in self.rows:
            words = [_word(chance, value) for values in row for value in values]
            if self.flaw() and words and self.has_points:
                words = words[:-1] if chance.random() < 0.5 else [*words, "1"]
                self.invents = True
            lines.append(f"{chance.choice(('', '', space))}{space.join(words)}")
            lines += [""] * (end == "\n" and chance.random() < 0.05)
        if self.flaw():
            lines = lines[:-1]
        elif chance.random() < 0.1:
            lines.append("1 2 3 4 5 6 7")  # one line more than POINTS
        text = end.join(lines) + (end if lines and chance.random() < 0.9 else "")
        return text.encode()


def _word(chance: random.Random, value: float) -> str:
    if value != value:
        return chance.choice(("nan", "NaN", "-nan"))
    if isinstance(value, float):
        return f"{value:{chance.choice(('.4f', 'g', '.6e'))}}" if abs(value) < 1e9 else repr(value)
    return str(value)


def _lzf(data: bytes) -> bytes:
    """Return data compressed by LZF, with literals only."""
    parts = [data[at : at + 32] for at in range(0, len(data), 32)]
    packed = b"".join(bytes([len(part) - 1]) + part for part in parts)
    return struct.pack("<II", len(packed), len(data)) + packed


def made(number: int) -> Made:
    """Return the file of a number."""
    cloud = _Cloud(number)
    content = cloud.header() + cloud.body()
    return Made(content, cloud.invents)
