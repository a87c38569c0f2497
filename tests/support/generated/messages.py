# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Messages of any type with values in all fields."""

from __future__ import annotations

import array
import importlib
import random
import sysconfig
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import rosidl_parser.definition as definition

import rmw_manycore_arrays as arrays

BORROWED_BYTES = 64 << 10
# Around the size from which arrays are not copied; the last ones leave different remainders.
LARGE_BYTES = (
    BORROWED_BYTES - 8,
    BORROWED_BYTES,
    *range(BORROWED_BYTES + 8, BORROWED_BYTES + 72, 8),
)
INTEGER_BITS = {"octet": 8, "char": 8, "int8": 8, "int16": 16, "int32": 32, "int64": 64}


def classes_with_number_fields() -> Iterator[Any]:
    """Import all installed packages, and return the message classes with such sequences."""
    for init in sorted(Path(sysconfig.get_path("purelib")).glob("*/msg/__init__.py")):
        package = importlib.import_module(f"{init.parents[1].name}.msg")
        for message in vars(package).values():
            if isinstance(message, type) and hasattr(message, "SLOT_TYPES"):
                message.__class__.__import_type_support__()
                if list(arrays.number_fields(message)):
                    yield message


def value_at(message: Any, path: str) -> Any:
    for name in path.split("."):
        message = getattr(message, name)
    return message


def made_message(message: Any, source: random.Random, is_large: bool) -> Any:
    """Return one with random values; its own number sequences are large."""
    made = message()
    for name, slot_type in zip(
        message.get_fields_and_field_types(), message.SLOT_TYPES, strict=False
    ):
        setattr(made, name, _value(getattr(made, name), slot_type, source, is_large))
    return made


def _value(default: Any, kind: Any, source: random.Random, is_large: bool) -> Any:
    if isinstance(default, array.array):
        return _numbers(default, kind, source, is_large)
    if isinstance(kind, definition.NamespacedType):
        return made_message(type_of(kind), source, is_large)
    if isinstance(kind, definition.BasicType):
        return _number(kind.typename, source)
    if isinstance(kind, definition.AbstractGenericString):
        return "".join(source.choices("abcdef", k=source.randrange(9)))
    if isinstance(kind, definition.Array):
        values = [_value(None, kind.value_type, source, False) for _ in range(kind.size)]
        return default.__class__(values) if isinstance(default, list) else _like(default, values)
    count = min(source.randrange(5), getattr(kind, "maximum_size", 5))
    return [_value(None, kind.value_type, source, False) for _ in range(count)]


def _like(default: Any, values: list[Any]) -> Any:
    return np.array(values, default.dtype)


def type_of(kind: Any) -> Any:
    return getattr(importlib.import_module(".".join(kind.namespaces)), kind.name)


def _numbers(default: Any, kind: Any, source: random.Random, is_large: bool) -> Any:
    size_bytes = source.choice((0, *LARGE_BYTES, *LARGE_BYTES)) if is_large else 64
    count = size_bytes // default.itemsize + (source.randrange(8) if size_bytes else 0)
    count = min(count, getattr(kind, "maximum_size", count))
    content = source.randbytes(count * default.itemsize)
    if default.typecode in "fd":  # no NaN, which is not equal to itself
        quarters = np.frombuffer(content, np.uint8, count) / 4
        content = quarters.astype(default.typecode).tobytes()
    return array.array(default.typecode, content)


def _number(typename: str, source: random.Random) -> Any:
    if typename == "boolean":
        return source.random() < 0.5
    if typename == "octet":
        return source.randbytes(1)
    if typename in ("float", "double"):
        return source.randrange(-1000, 1000) / 8
    bits = INTEGER_BITS[typename.removeprefix("u")]
    low = 0 if typename.startswith("u") else -(1 << (bits - 1))
    return source.randrange(low, low + (1 << bits))
