# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Node parameters as a frozen dataclass: name, default and range in one place."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, fields
from typing import Any, TypeVar

import numpy as np
from rcl_interfaces.msg import ParameterDescriptor
from rclpy.node import Node

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError

T = TypeVar("T")


@dataclass(frozen=True)
class Range:
    """Allowed values of a number; `choices` overrides the limits."""

    above: float | None = None
    min_value: float | None = None
    max_value: float | None = None
    choices: tuple[Any, ...] = ()

    def __str__(self) -> str:
        if self.choices:
            return "one of " + ", ".join(str(choice) for choice in self.choices)
        limits = [
            ("more than", self.above),
            ("at least", self.min_value),
            ("at most", self.max_value),
        ]
        words = [f"{word} {limit:g}" for word, limit in limits if limit is not None]
        return " and ".join(words) or "finite"

    def holds(self, value: Any) -> bool:
        """Return whether a value is in the range; NaN never is."""
        if self.choices:
            return value in self.choices
        return not (
            not np.isfinite(value)
            or (self.above is not None and value <= self.above)
            or (self.min_value is not None and value < self.min_value)
            or (self.max_value is not None and value > self.max_value)
        )


def parameter(name: str, default: Any, **limits: Any) -> Any:
    """Return the dataclass field of a parameter; limits are those of Range, or a list's `length`.

    Numbers must be finite; texts non-empty unless the default is empty. `whole` declares a list of
    non-negative integers, `texts` a list of strings, for which a single string is accepted.
    """
    length, whole = limits.pop("length", None), limits.pop("whole", False)
    texts = limits.pop("texts", False)
    allowed = Range(**limits) if limits else None
    metadata = {"name": name, "default": default, "allowed": allowed, "texts": texts}
    return field(default=default, metadata={**metadata, "length": length, "whole": whole})


def declare(node: Node, kind: type[T]) -> T:
    """Declare all parameters of a dataclass and return their values.

    Integers are accepted for floats; lists become tuples.

    :raises ManycoreError: for all invalid values together.
    """
    values: dict[str, Any] = {}
    problems = []
    for one in fields(kind):  # type: ignore[arg-type]
        name, default = one.metadata["name"], one.metadata["default"]
        value = _declared(node, name, default)
        if one.metadata["texts"]:
            value = (value,) if isinstance(value, str) and value else value or ()
            expected = _expected_texts(value)
        elif isinstance(default, tuple):
            expected = _expected_list(value, one.metadata["length"], one.metadata["whole"])
        else:
            expected = _expected(value, default, one.metadata["allowed"])
        if expected is not None:
            problems.append(f"parameter {name}: expected {expected}, found {value!r}")
        values[one.name] = float(value) if isinstance(default, float) and not expected else value
    if problems:
        raise ManycoreError("\n".join(problems), EXIT_BAD_INPUT)
    return kind(**values)


def _declared(node: Node, name: str, default: Any) -> Any:
    """Return the given value or the default; lists as tuples."""
    dynamic = ParameterDescriptor(dynamic_typing=True)
    start = list(default) if isinstance(default, tuple) else default
    # An empty list has no type to declare it with.
    value = node.declare_parameter(name, None if start == [] else start, dynamic).value
    if isinstance(default, tuple):
        is_list = isinstance(value, Sequence) and not isinstance(value, str)
        return tuple(value) if is_list else () if value is None else value
    return value


def _expected(value: Any, default: Any, allowed: Range | None) -> str | None:
    """Return what was expected, or None for a valid value."""
    if isinstance(default, bool):
        return None if isinstance(value, bool) else "true or false"
    if isinstance(default, str):
        kind = "text" if allowed is None and not default else "text that is not empty"
        right = isinstance(value, str) and (bool(value) or not default)
    elif isinstance(default, int):
        kind, right = "a whole number", _is_number(value, whole=True)
    else:
        kind, right = "a number", _is_number(value)
        allowed = allowed or Range()
    if not right:
        return kind if allowed is None else f"{kind}, {allowed}"
    return None if allowed is None or allowed.holds(value) else str(allowed)


def _expected_list(value: Any, length: int | None, whole: bool) -> str | None:
    kind = "whole numbers, none negative" if whole else "finite numbers"
    expected = kind if length is None else f"{length} {kind}"
    if not isinstance(value, tuple) or (length is not None and len(value) != length):
        return expected
    right = all(_is_number(one, whole) and np.isfinite(one) for one in value)
    return None if right and not (whole and any(one < 0 for one in value)) else expected


def _expected_texts(value: Any) -> str | None:
    right = isinstance(value, tuple) and all(isinstance(one, str) and one for one in value)
    return None if right else "a text, or a list of texts that are not empty"


def _is_number(value: Any, whole: bool = False) -> bool:
    """Return whether a value is a number, finite or not; booleans are not."""
    return isinstance(value, int if whole else (int, float)) and not isinstance(value, bool)
