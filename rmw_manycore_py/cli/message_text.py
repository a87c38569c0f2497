# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Messages as plain data and as the YAML that `ros2 topic echo` prints."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import yaml

# What `ros2 topic echo` shows of a long string or array unless it is told otherwise.
SHOWN_LENGTH = 128
ELLIPSIS = "..."


def to_plain(value: Any, shown_length: int | None = None) -> Any:
    """Return a message, or a value in one, as dicts, lists and scalars; None = in full length."""
    if hasattr(value, "get_fields_and_field_types"):
        fields = value.get_fields_and_field_types()
        return {name: to_plain(getattr(value, name), shown_length) for name in fields}
    if isinstance(value, str):
        return _shortened(value, shown_length, ELLIPSIS)
    if isinstance(value, bytes):
        return value[0] if len(value) == 1 else to_plain(list(value), shown_length)
    if isinstance(value, (bool, int, float)):
        return value
    return _list(value, shown_length)


def to_yaml(message: Any, shown_length: int | None = SHOWN_LENGTH) -> str:
    """Return a message as a YAML document without its separator."""
    data = to_plain(message, shown_length)
    return str(yaml.safe_dump(data, sort_keys=False, allow_unicode=True, width=float("inf")))


def _list(values: Any, shown_length: int | None) -> list[Any]:
    """Arrays of numbers are numpy's or array.array's; only what is shown is converted."""
    shown = values[:shown_length] if shown_length is not None else values
    items = shown.tolist() if hasattr(shown, "tolist") else list(shown)
    plain = [to_plain(item, shown_length) for item in items]
    return [*plain, ELLIPSIS] if len(shown) < len(values) else plain


def _shortened(text: Sequence[Any], shown_length: int | None, end: str) -> Any:
    if shown_length is None or len(text) <= shown_length:
        return text
    return f"{text[:shown_length]}{end}"
