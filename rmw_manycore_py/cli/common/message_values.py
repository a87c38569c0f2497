# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Fill messages from YAML given on the command line."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from rosidl_parser.definition import (
    AbstractGenericString,
    AbstractNestedType,
    BasicType,
    NamespacedType,
)

from rmw_manycore_py.cli.common.interface_types import load_type
from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError, MapfileError
from rmw_manycore_py.errors.suggestions import did_you_mean
from rmw_manycore_py.mapfile.format.document import parse_yaml, read_text

# Values that stand for the current time in place of a message.
STAMPS = {("std_msgs", "Header"): "auto", ("builtin_interfaces", "Time"): "now"}

_DOCUMENT_END = re.compile(r"^---[ \t]*$", re.MULTILINE)


def parse_values(text: str) -> dict[str, Any]:
    """Parse the fields in a YAML text; empty text has none."""
    try:
        values = parse_yaml(text, Path("values")).data or {}
    except MapfileError as error:
        raise _wrong(f"not YAML: {error}") from error
    if not isinstance(values, dict):
        raise _wrong(f"expected fields like '{{data: 1}}', found '{text}'")
    return values


def read_values(file: Path) -> list[dict[str, Any]]:
    """Parse each YAML document in a file; documents are separated by --- lines."""
    documents = _DOCUMENT_END.split(read_text(file))
    found = [parse_values(text) for text in documents if text.strip()]
    if not found:
        raise _wrong(f"{file}: expected the fields of a message, found nothing")
    return found


def message_of(message_type: Any, values: Mapping[str, Any], stamp: Any = None) -> Any:
    """Return a message with these values, defaults elsewhere.

    `auto` for a header and `now` for a time are replaced by `stamp`, a builtin_interfaces Time.
    """
    return _Filler(stamp).message(message_type, values, "")


def _wrong(text: str) -> ManycoreError:
    return ManycoreError(text, EXIT_BAD_INPUT)


class _Filler:
    def __init__(self, stamp: Any) -> None:
        self._stamp = stamp

    def message(self, message_type: Any, values: Any, path: str) -> Any:
        if not isinstance(values, Mapping):
            raise _wrong(f"{path}: expected the fields of a {message_type.__name__}")
        message = message_type(check_fields=True)
        names = message.get_fields_and_field_types()
        types = dict(zip(names, message_type.SLOT_TYPES, strict=True))
        for name, value in values.items():
            if name not in types:
                meant = did_you_mean(name, names) or f"; there is {', '.join(names) or 'none'}"
                raise _wrong(f"Failed to populate field: no field '{path}{name}'{meant}")
            try:
                setattr(message, name, self._converted(types[name], value, f"{path}{name}"))
            except (AssertionError, TypeError, ValueError, OverflowError) as error:
                expected = names[name]
                raise _wrong(
                    f"Failed to populate field: {path}{name}: expected {expected}, found {value!r}"
                ) from error
        return message

    def _converted(self, kind: Any, value: Any, path: str) -> Any:
        """Convert a value to what the setter of a field of this kind accepts."""
        if isinstance(kind, AbstractNestedType):
            if isinstance(value, str) or not isinstance(value, Sequence):
                raise ValueError
            return [
                self._converted(kind.value_type, v, f"{path}[{i}]") for i, v in enumerate(value)
            ]
        if isinstance(kind, NamespacedType):
            return self._nested(kind, value, path)
        if isinstance(kind, AbstractGenericString):
            return _text(value)
        return _scalar(kind, value)

    def _nested(self, kind: Any, value: Any, path: str) -> Any:
        package, name = kind.namespaces[0], kind.name
        nested_type = load_type("/".join((*kind.namespaces, name)), kind.namespaces[1])
        if self._stamp is not None and value == STAMPS.get((package, name)):
            return self._stamp if name == "Time" else nested_type(stamp=self._stamp)
        return self.message(nested_type, value, f"{path}.")


def _text(value: Any) -> str:
    if isinstance(value, (Mapping, list)):
        raise TypeError
    return str(value)


def _scalar(kind: BasicType, value: Any) -> Any:
    if kind.typename in ("float", "double") and not isinstance(value, bool):
        return float(value)
    if kind.typename == "octet":
        return bytes([value])
    if kind.typename != "boolean" and isinstance(value, bool):
        raise TypeError
    return value
