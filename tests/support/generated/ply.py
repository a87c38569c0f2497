# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""PLY files made at random, whole or cut."""

from __future__ import annotations

import random
import struct
from dataclasses import dataclass

_TYPES = {
    "char": "b", "int8": "b", "uchar": "B", "uint8": "B", "short": "h", "int16": "h",
    "ushort": "H", "uint16": "H", "int": "i", "int32": "i", "uint": "I", "uint32": "I",
    "float": "f", "float32": "f", "double": "d", "float64": "d",
}  # fmt: skip
_FLOATS = ("float", "float32", "double", "float64")
_ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}


@dataclass(frozen=True)
class Made:
    """A file, and the positions that were written to it."""

    content: bytes
    points: list[tuple[float, ...]]
    is_cut: bool  # some are missing
    is_ordered: bool  # x comes before y, and y before z


def made(number: int) -> Made:
    """Return the file of a number."""
    chance = random.Random(number)
    encoding = chance.choice(list(_ORDERS))
    others = chance.sample(("nx", "red", "intensity", "t"), chance.choice((0, 1, 3)))
    names = ["x", "y", "z", *others]
    if chance.random() < 0.3:
        chance.shuffle(names)
    kinds = [chance.choice(_FLOATS if chance.random() < 0.8 else list(_TYPES)) for _ in names]
    rows = [
        [_value(chance, kind) for kind in kinds] for _ in range(chance.choice((1, 2, 3, 7, 20)))
    ]
    before = _list_element(chance, encoding) if chance.random() < 0.15 else (b"", b"")
    header = _header(chance, encoding, before[0], list(zip(names, kinds, strict=True)), len(rows))
    body, place = _body(chance, encoding, kinds, rows)
    axes = [names.index(axis) for axis in "xyz"]
    points = [tuple(float(row[axis]) for axis in axes) for row in rows]
    is_cut = chance.random() < 0.2
    if is_cut:
        body = body[: chance.randrange(place)]
    return Made(header + before[1] + body, points, is_cut, is_ordered=axes == sorted(axes))


def _value(chance: random.Random, kind: str) -> float:
    return chance.randrange(-800, 800) / 8 if kind in _FLOATS else chance.randrange(100)


def _list_element(chance: random.Random, encoding: str) -> tuple[bytes, bytes]:
    """Return the header and the data of an element with lists."""
    lists = [[chance.randrange(9) for _ in range(chance.randrange(4))] for _ in range(3)]
    header = b"element strip 3\nproperty uchar kind\nproperty list uchar int indices\n"
    if encoding == "ascii":
        return header, "".join(
            f"7 {len(one)} {' '.join(map(str, one))}\n" for one in lists
        ).encode()
    order = _ORDERS[encoding]
    parts = (struct.pack(f"{order}BB{len(one)}i", 7, len(one), *one) for one in lists)
    return header, b"".join(parts)


def _header(
    chance: random.Random,
    encoding: str,
    before: bytes,
    properties: list[tuple[str, str]],
    count: int,
) -> bytes:
    lines = ["ply", f"format {encoding} 1.0"]
    more = ("comment made of nothing", "comment end_header is below", "comment element vertex 7")
    lines += [chance.choice((*more, "obj_info num_cols 3"))] * (chance.random() < 0.4)
    lines += before.decode().splitlines()
    lines.append(f"element vertex {count}")
    lines += [f"property {kind} {name}" for name, kind in properties]
    lines += ["element face 0", "property list uchar int vertex_indices"] * (chance.random() < 0.4)
    lines.append("end_header")
    end = chance.choice(("\n", "\n", "\r\n"))
    return "".join(line + end for line in lines).encode()


def _body(
    chance: random.Random, encoding: str, kinds: list[str], rows: list[list[float]]
) -> tuple[bytes, int]:
    """Return the data, and where it can be cut without a number being cut unnoticed."""
    if encoding != "ascii":
        form = _ORDERS[encoding] + "".join(_TYPES[kind] for kind in kinds)
        data = b"".join(struct.pack(form, *row) for row in rows)
        return data, len(data)
    lines = [" ".join(map(repr, row)) for row in rows]
    text = chance.choice(("\n", "\n", "\r\n", " ", "\t", " \n")).join(lines)
    last = len(text) - len(repr(rows[-1][-1]))
    return f"{text}\n".encode(), last
