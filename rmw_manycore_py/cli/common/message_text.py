# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Messages as plain data, and as YAML and CSV in the format of `ros2 topic echo`."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import yaml

from rmw_manycore_py.cli.common.printing import escaped, printable

# Default truncation length of `ros2 topic echo`.
SHOWN_LENGTH = 128
ELLIPSIS = "..."
_SEQUENCE = re.compile(r"sequence<([\w/]+)(?:<\d+>)?(?:, (\d+))?>")
_ARRAY = re.compile(r"([\w/]+)(?:<\d+>)?\[(\d+)\]")


@dataclass(frozen=True)
class Shown:
    """Limits on the parts of a message that are shown; None shows all."""

    length: int | None = None
    arrays: bool = True
    strings: bool = True


ALL = Shown()
BRIEFLY = Shown(SHOWN_LENGTH)


def to_plain(value: Any, shown: Shown = ALL) -> Any:
    """Convert a message, or a value in one, to dicts, lists and scalars."""
    if is_message(value):
        fields = value.get_fields_and_field_types()
        return {
            name: _field(getattr(value, name), type_name, shown)
            for name, type_name in fields.items()
        }
    if isinstance(value, str):
        return _string(value, shown)
    if isinstance(value, bytes):
        return value[0] if len(value) == 1 else to_plain(list(value), shown)
    if isinstance(value, (bool, int, float)):
        return value
    return _list(value, shown)


def is_message(value: Any) -> bool:
    """Return whether a value is a message."""
    return hasattr(value, "get_fields_and_field_types")


def shortened(text: str, length: int) -> str:
    """Return a text, cut to this many characters."""
    return text if len(text) <= length else text[:length] + ELLIPSIS


class _LinePerField(yaml.SafeDumper):
    """Writes only arrays in flow style, as `ros2 topic echo --flow-style` does."""


_LinePerField.add_representer(
    dict,
    lambda dumper, fields: dumper.represent_mapping(
        "tag:yaml.org,2002:map", fields, flow_style=False
    ),
)
# Printed, control characters are escaped; within double quotes, YAML reads the escapes back.
_LinePerField.add_representer(
    str,
    lambda dumper, text: dumper.represent_scalar(
        "tag:yaml.org,2002:str", text, style=None if printable(text) == text else '"'
    ),
)


def to_yaml(message: Any, shown: Shown = BRIEFLY, *, flow_style: bool = False) -> str:
    """Format a message as a YAML document, without the separator."""
    return plain_to_yaml(to_plain(message, shown), flow_style=flow_style)


def plain_to_yaml(plain: Any, *, flow_style: bool = False) -> str:
    """Format the result of `to_plain` as a YAML document."""
    text = yaml.dump(
        plain,
        Dumper=_LinePerField,
        sort_keys=False,
        allow_unicode=True,
        width=float("inf"),
        default_flow_style=flow_style,
    )
    if isinstance(plain, (dict, list)):
        return str(text)
    return str(text).removesuffix("...\n")  # document end marker after a single scalar


def to_csv(message: Any, shown: Shown = BRIEFLY) -> str:
    """Return the values of a message in a line, comma-separated, in the order of its fields."""
    return ",".join(escaped(str(value)) for value in _values(to_plain(message, shown)))


def _values(plain: Any) -> Iterator[Any]:
    if isinstance(plain, (dict, list)):
        for part in plain.values() if isinstance(plain, dict) else plain:
            yield from _values(part)
    else:
        yield plain


def _field(value: Any, type_name: str, shown: Shown) -> Any:
    if not shown.arrays:
        if match := _SEQUENCE.fullmatch(type_name):
            bound = f"[{match[2]}]" if match[2] else ""
            return f"<sequence type: {_full(match[1])}{bound}, length: {len(value)}>"
        if match := _ARRAY.fullmatch(type_name):
            return f"<array type: {_full(match[1])}[{match[2]}]>"
    return to_plain(value, shown)


def _full(type_name: str) -> str:
    """Expand std_msgs/Header to std_msgs/msg/Header."""
    return "/msg/".join(type_name.split("/"))


def _string(text: str, shown: Shown) -> str:
    if not shown.strings:
        return f"<string length: <{len(text)}>>"
    return text if shown.length is None else shortened(text, shown.length)


def _list(values: Sequence[Any], shown: Shown) -> list[Any]:
    """Convert only the shown part of a numpy or array.array field."""
    part: Any = values[: shown.length] if shown.length is not None else values
    items = part.tolist() if hasattr(part, "tolist") else list(part)
    plain = [to_plain(item, shown) for item in items]
    return [*plain, ELLIPSIS] if len(part) < len(values) else plain
