# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Parameters of a node of the reference system."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from typing import Any

from manycore_reference_msgs import msg
from rclpy.node import Node
from rclpy.parameter import Parameter

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError

MESSAGES = {
    f"manycore_reference_msgs/msg/{kind.__name__}": kind
    for kind in (
        *(msg.Message4kb, msg.Message64kb, msg.Message256kb),
        *(msg.Message1024kb, msg.Message5120kb),
    )
}
SMALLEST = next(iter(MESSAGES))
PAYLOADS = ("untouched", "checked")
KEEP_ALL = 0


@dataclass(frozen=True)
class Settings:
    """Parameters of a node; `depth` 0 keeps all messages."""

    kind: str
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    period_ms: int
    crunch_ms: float
    message: type[Any]
    checked: bool
    depth: int
    report_period_ms: int


def read_settings(node: Node, kinds: Collection[str]) -> Settings:
    """Declare the parameters and return their values; raise ManycoreError for an invalid one."""

    def value(name: str, default: Any) -> Any:
        return node.declare_parameter(name, default).value

    def topics(name: str) -> tuple[str, ...]:
        return tuple(value(name, Parameter.Type.STRING_ARRAY) or ())

    return Settings(
        kind=_one_of("kind", value("kind", ""), kinds),
        inputs=topics("inputs"),
        outputs=topics("outputs") or (node.get_name(),),
        period_ms=value("period_ms", 100),
        crunch_ms=value("crunch_ms", 1.0),
        message=MESSAGES[_one_of("message", value("message", SMALLEST), MESSAGES)],
        checked=_one_of("payload", value("payload", PAYLOADS[0]), PAYLOADS) == "checked",
        depth=value("depth", 1),
        report_period_ms=value("report_period_ms", 0),
    )


def _one_of(name: str, found: str, allowed: Collection[str]) -> str:
    if found not in allowed:
        raise ManycoreError(
            f"parameter {name}: expected one of {', '.join(allowed)}, found {found!r}",
            EXIT_BAD_INPUT,
        )
    return found
