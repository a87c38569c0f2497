# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Checks that a PLY file is complete: Open3D invents missing points."""

from __future__ import annotations

from pathlib import Path

SIZES = {
    **dict.fromkeys(("char", "uchar", "int8", "uint8"), 1),
    **dict.fromkeys(("short", "ushort", "int16", "uint16"), 2),
    **dict.fromkeys(("int", "uint", "int32", "uint32", "float", "float32"), 4),
    **dict.fromkeys(("double", "float64"), 8),
}
LONGEST_HEADER = 100_000  # bytes
END = b"end_header"


def check_ply(path: Path) -> None:
    """Raise ValueError for a truncated file.

    Files whose points are not the first element, or contain lists, are not checked.
    """
    raw = path.read_bytes()
    header, end, _ = raw[:LONGEST_HEADER].partition(END)
    if not end:
        raise ValueError(f"it has no points: its header has no {END.decode()}")
    lines = [line.split() for line in header.decode("ascii", "replace").splitlines()]
    encoding = next((line[1] for line in lines if line[:1] == ["format"] and line[1:]), "")
    points, kinds = _first_element(lines)
    data = raw[len(header) :].partition(b"\n")[2]
    if not all(kind in SIZES for kind in kinds):
        return
    if encoding == "ascii":
        needed, found, what = points, len(data.splitlines()), "lines"
    else:
        needed, found, what = points * sum(SIZES[kind] for kind in kinds), len(data), "bytes"
    if found < needed:
        raise ValueError(f"its {points} points need {needed} {what}, found {found}")


def _first_element(lines: list[list[str]]) -> tuple[int, list[str]]:
    """Return number and types of the points; 0 if they are not the first element."""
    at = next((i for i, line in enumerate(lines) if line[:1] == ["element"]), len(lines))
    if at == len(lines) or lines[at][1:2] != ["vertex"]:
        return 0, []
    kinds = []
    for line in lines[at + 1 :]:
        if line[:1] == ["element"]:
            break
        if line[:1] == ["property"]:
            kinds += line[1:2]
    return int("".join(lines[at][2:3]) or 0), kinds
