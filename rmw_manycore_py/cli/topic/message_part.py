# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Message fields by path, such as pose.position or status[0].name; and message filters."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

from rmw_manycore_py.cli.common.message_text import is_message
from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError

_STEP = re.compile(r"(\w+)((?:\[-?\d+\])*)")
_INDEX = re.compile(r"-?\d+")


def part_of(message: Any, path: str) -> Any:
    """Return the field of a message at a path; an empty path returns the message."""
    value = message
    for step in filter(None, path.split(".")):
        match = _STEP.fullmatch(step)
        if match is None:
            raise _wrong(f"expected a path such as pose.position.x or data[0], found '{path}'")
        value = _field(value, match[1])
        for index in _INDEX.findall(match[2]):
            value = _element(value, int(index), step)
    return value


def _field(value: Any, name: str) -> Any:
    names = list(value.get_fields_and_field_types()) if is_message(value) else []
    if name not in names:
        raise _wrong(f"Invalid field '{name}': there is {', '.join(names) or 'none, only a value'}")
    return getattr(value, name)


def _element(value: Any, index: int, step: str) -> Any:
    try:
        return value[index]
    except (IndexError, TypeError) as error:
        raise _wrong(f"no element '{step}': {error}") from error


def message_filter(expression: str | None) -> Callable[[Any], bool]:
    """Return a predicate that evaluates a Python expression on a message `m`."""
    if expression is None:
        return lambda _message: True
    try:
        code = compile(expression, "the filter", "eval")
    except (SyntaxError, ValueError) as error:
        raise _wrong(f"the filter is not a Python expression: {error}") from error

    def fulfils(message: Any) -> bool:
        try:
            return bool(eval(code, {"m": message}))
        except Exception as error:
            raise _wrong(f"the filter fails: {type(error).__name__}: {error}") from error

    return fulfils


def _wrong(text: str) -> ManycoreError:
    return ManycoreError(text, EXIT_BAD_INPUT)
