# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The options --qos-* of verbs that publish, and of those that listen."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import click

_Command = Callable[..., None]


@dataclass(frozen=True)
class QosOptions:
    """What was asked for, as ROS 2 names it; None = nothing in particular."""

    reliability: str | None = None
    durability: str | None = None
    history: str | None = None
    depth: int | None = None

    def profile(self, *, reliable: bool = True, kept: bool = False) -> Any:
        """Return it as an rclpy QoSProfile, with these policies where none was asked for."""
        from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy

        reliability = self.reliability or ("reliable" if reliable else "best_effort")
        durability = self.durability or ("transient_local" if kept else "volatile")
        return QoSProfile(
            reliability=ReliabilityPolicy[reliability.upper()],
            durability=DurabilityPolicy[durability.upper()],
            history=HistoryPolicy[(self.history or "keep_last").upper()],
            depth=self.depth or 10,
        )


def _qos_options(unasked: str | None) -> Callable[[_Command], _Command]:
    """Return a decorator; `unasked` says what holds for policies that are not given."""

    def choice(policy: str, *values: str) -> Callable[[_Command], _Command]:
        return click.option(
            f"--qos-{policy}",
            type=click.Choice(values),
            default=None if unasked else values[0],
            show_default=unasked or True,
        )

    def decorate(function: _Command) -> _Command:
        @choice("reliability", "reliable", "best_effort")
        @choice("durability", "volatile", "transient_local")
        @click.option(
            "--qos-history",
            type=click.Choice(("keep_last", "keep_all")),
            default="keep_last",
            show_default=True,
        )
        @click.option("--qos-depth", type=click.IntRange(1), default=10, show_default=True)
        @functools.wraps(function)
        def with_qos(
            qos_reliability: str | None,
            qos_durability: str | None,
            qos_history: str,
            qos_depth: int,
            **others: Any,
        ) -> None:
            qos = QosOptions(qos_reliability, qos_durability, qos_history, qos_depth)
            function(qos=qos, **others)

        return with_qos

    return decorate


# Give a command the options --qos-*, which reach it as the argument `qos`.
qos_options = _qos_options(None)
qos_request_options = _qos_options("what all publishers offer")
