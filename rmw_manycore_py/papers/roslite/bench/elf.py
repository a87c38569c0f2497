# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Sizes of ELF files as loaded: text, data and bss, from their program headers."""

from __future__ import annotations

import struct
from dataclasses import dataclass
from pathlib import Path

_MAGIC = b"\x7fELF\x02\x01"  # 64 bits, little endian
_HEADER = struct.Struct("<32xQ14xHH")  # offset, size and number of program headers
_SEGMENT = struct.Struct("<IIQQQQQQ")  # type, flags, offset, address, -, in file, in memory, -
_LOAD, _WRITABLE = 1, 2


@dataclass(frozen=True)
class Sizes:
    """Bytes; text is all that is not written to."""

    text: int = 0
    bss: int = 0
    data: int = 0

    def __add__(self, other: Sizes) -> Sizes:
        return Sizes(self.text + other.text, self.bss + other.bss, self.data + other.data)


def sizes_of(path: Path) -> Sizes | None:
    """Return the sizes of a program or library; None for any other file."""
    with path.open("rb") as file:
        head = file.read(64)
        if len(head) < 64 or not head.startswith(_MAGIC):
            return None
        offset, size, count = _HEADER.unpack_from(head)
        file.seek(offset)
        table = file.read(size * count)
    found = Sizes()
    for number in range(count):
        kind, flags, _, _, _, in_file, in_memory, _ = _SEGMENT.unpack_from(table, number * size)
        if kind == _LOAD and flags & _WRITABLE:
            found += Sizes(data=in_file, bss=in_memory - in_file)
        elif kind == _LOAD:
            found += Sizes(text=in_file)
    return found


def loaded_files(pid: int) -> list[Path]:
    """Return the files that a process has mapped and that can be read."""
    maps = Path(f"/proc/{pid}/maps").read_text().splitlines()
    names = (line.split(maxsplit=5)[5:] for line in maps)
    paths = {Path(name[0].strip()) for name in names if name and name[0].startswith("/")}
    return sorted(path for path in paths if path.is_file())
