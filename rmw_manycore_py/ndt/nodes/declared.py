# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Parameters of a node as a frozen dataclass: name, default and range of each in one place."""

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
    """What a number must be; `choices` wins over the limits."""

    above: float | None = None
    least: float | None = None
    most: float | None = None
    choices: tuple[Any, ...] = ()

    def __str__(self) -> str:
        if self.choices:
            return "one of " + ", ".join(str(choice) for choice in self.choices)
        limits = [("more than", self.above), ("at least", self.least), ("at most", self.most)]
        return " and ".join(f"{word} {limit:g}" for word, limit in limits if limit is not None)

    def holds(self, value: Any) -> bool:
        """Tell whether a value is in the range; NaN never is."""
        if self.choices:
            return value in self.choices
        return not (
            not np.isfinite(value)
            or (self.above is not None and value <= self.above)
            or (self.least is not None and value < self.least)
            or (self.most is not None and value > self.most)
        )


def parameter(name: str, default: Any, **limits: Any) -> Any:
    """Return the field of a parameter; the limits are those of Range, or `length` of a list."""
    length = limits.pop("length", None)
    allowed = Range(**limits) if limits else None
    metadata = {"name": name, "default": default, "allowed": allowed, "length": length}
    return field(default=default, metadata=metadata)


def declare(node: Node, kind: type[T]) -> T:
    """Declare all parameters of a dataclass and return their values.

    Whole numbers are taken for decimal ones, lists become tuples. All that are wrong are named in
    one ManycoreError.
    """
    values: dict[str, Any] = {}
    problems = []
    for one in fields(kind):  # type: ignore[arg-type]
        name, default = one.metadata["name"], one.metadata["default"]
        value = _declared(node, name, default)
        expected = _expected(value, default, one.metadata["allowed"], one.metadata["length"])
        if expected is not None:
            problems.append(f"parameter {name}: expected {expected}, found {value!r}")
        values[one.name] = float(value) if isinstance(default, float) and not expected else value
    if problems:
        raise ManycoreError("\n".join(problems), EXIT_BAD_INPUT)
    return kind(**values)


def _declared(node: Node, name: str, default: Any) -> Any:
    """Return the value that was given, else the default; lists as tuples."""
    dynamic = ParameterDescriptor(dynamic_typing=True)
    start = list(default) if isinstance(default, tuple) else default
    # An empty list has no type that it could be declared with.
    value = node.declare_parameter(name, None if start == [] else start, dynamic).value
    if isinstance(default, tuple):
        is_list = isinstance(value, Sequence) and not isinstance(value, str)
        return tuple(value) if is_list else () if value is None else value
    return value


def _expected(value: Any, default: Any, allowed: Range | None, length: int | None) -> str | None:
    """Return what was expected, or None for a value that is right."""
    if isinstance(default, tuple):
        return _expected_list(value, length)
    if isinstance(default, bool):
        return None if isinstance(value, bool) else "true or false"
    if isinstance(default, str):
        right = isinstance(value, str)
        kind = "text"
    elif isinstance(default, int):
        right = isinstance(value, int) and not isinstance(value, bool)
        kind = "a whole number"
    else:
        right = isinstance(value, (int, float)) and not isinstance(value, bool)
        kind = "a number"
    if not right:
        return kind if allowed is None else f"{kind}, {allowed}"
    return None if allowed is None or allowed.holds(value) else str(allowed)


def _expected_list(value: Any, length: int | None) -> str | None:
    expected = "finite numbers" if length is None else f"{length} finite numbers"
    if not isinstance(value, tuple) or (length is not None and len(value) != length):
        return expected
    numbers = all(isinstance(one, (int, float)) and np.isfinite(one) for one in value)
    return None if numbers else expected
