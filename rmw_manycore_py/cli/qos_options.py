# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The options --qos-* of verbs that publish."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import click


@dataclass(frozen=True)
class QosOptions:
    """What was asked for, as ROS 2 names it."""

    reliability: str
    durability: str
    history: str
    depth: int

    def profile(self) -> Any:
        """Return it as an rclpy QoSProfile."""
        from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy

        return QoSProfile(
            reliability=ReliabilityPolicy[self.reliability.upper()],
            durability=DurabilityPolicy[self.durability.upper()],
            history=HistoryPolicy[self.history.upper()],
            depth=self.depth,
        )


def qos_options(function: Callable[..., None]) -> Callable[..., None]:
    """Give a command the options --qos-*, which reach it as the argument `qos`."""

    @_choice("reliability", "reliable", "best_effort")
    @_choice("durability", "volatile", "transient_local")
    @_choice("history", "keep_last", "keep_all")
    @click.option("--qos-depth", type=click.IntRange(1), default=10, show_default=True)
    @functools.wraps(function)
    def with_qos(
        qos_reliability: str, qos_durability: str, qos_history: str, qos_depth: int, **others: Any
    ) -> None:
        function(qos=QosOptions(qos_reliability, qos_durability, qos_history, qos_depth), **others)

    return with_qos


def _choice(policy: str, *values: str) -> Callable[[Callable[..., None]], Callable[..., None]]:
    return click.option(
        f"--qos-{policy}", type=click.Choice(values), default=values[0], show_default=True
    )
