# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The options --qos-* of verbs that publish and of verbs that subscribe."""

from __future__ import annotations

import functools
from collections.abc import Callable
from copy import copy
from dataclasses import dataclass
from typing import Any

import click

from rmw_manycore_py.cli.common.finite_range import MAX_DEPTH, FiniteRange, WholeRange

_Command = Callable[..., None]

# Names of rclpy, which --help does not import.
PRESETS = (
    *("unknown", "default", "system_default", "sensor_data", "services_default", "parameters"),
    *("parameter_events", "action_status_default", "best_available"),
)
POLICIES = {
    "history": ("system_default", "keep_last", "keep_all", "unknown"),
    "reliability": ("system_default", "reliable", "best_effort", "unknown", "best_available"),
    "durability": ("system_default", "transient_local", "volatile", "unknown", "best_available"),
    "liveliness": ("system_default", "automatic", "manual_by_topic", "unknown", "best_available"),
}
_PUBLISHING, _LISTENING = "default", "sensor_data"


@dataclass(frozen=True)
class QosOptions:
    """Requested QoS, in ROS 2 terms; None takes the value of the preset."""

    preset: str = _LISTENING
    reliability: str | None = None
    durability: str | None = None
    history: str | None = None
    liveliness: str | None = None
    depth: int | None = None
    lease_s: float | None = None

    def profile(self, *, reliable: bool | None = None, kept: bool | None = None) -> Any:
        """Return the rclpy QoSProfile.

        :param reliable, kept: what publishers offer, for policies that were not requested.
        """
        from rclpy import qos
        from rclpy.duration import Duration

        profile = copy(qos.QoSPresetProfiles.get_from_short_key(self.preset))
        if reliability := self.reliability or _offered(reliable, "reliable", "best_effort"):
            profile.reliability = qos.ReliabilityPolicy.get_from_short_key(reliability)
        if durability := self.durability or _offered(kept, "transient_local", "volatile"):
            profile.durability = qos.DurabilityPolicy.get_from_short_key(durability)
        if self.history:
            profile.history = qos.HistoryPolicy.get_from_short_key(self.history)
        if self.liveliness:
            profile.liveliness = qos.LivelinessPolicy.get_from_short_key(self.liveliness)
        if self.lease_s is not None:
            profile.liveliness_lease_duration = Duration(nanoseconds=int(self.lease_s * 1e9))
        if self.depth is not None:
            profile.depth = self.depth
        return profile


def _offered(offer: bool | None, strong: str, weak: str) -> str | None:
    return None if offer is None else strong if offer else weak


def _qos_options(preset: str, unasked: str) -> Callable[[_Command], _Command]:
    """Return a decorator; `unasked` describes policies that are not given."""

    def policy(name: str) -> Callable[[_Command], _Command]:
        return click.option(
            f"--qos-{name}", name, type=click.Choice(POLICIES[name]), help=f"QoS: {name}."
        )

    def decorate(function: _Command) -> _Command:
        @click.option(
            "--qos-profile",
            "preset",
            type=click.Choice(PRESETS),
            default=preset,
            show_default=True,
            help=f"QoS preset; for policies not given, {unasked}.",
        )
        @policy("reliability")
        @policy("durability")
        @policy("history")
        @click.option(
            "--qos-depth",
            "depth",
            metavar="N",
            type=WholeRange(1, MAX_DEPTH),
            help="QoS: messages kept.",
        )
        @policy("liveliness")
        @click.option(
            "--qos-liveliness-lease-duration-seconds",
            "lease_s",
            metavar="S",
            type=FiniteRange(min=0, min_open=True),
            help="QoS: time within which a publisher shows that it is alive.",
        )
        @functools.wraps(function)
        def with_qos(**options: Any) -> None:
            asked = {name: options.pop(name) for name in QosOptions.__dataclass_fields__}
            function(qos=QosOptions(**asked), **options)

        return with_qos

    return decorate


# Add the options --qos-* to a command, as the argument `qos`.
qos_options = _qos_options(_PUBLISHING, "it decides")
qos_request_options = _qos_options(
    _LISTENING, "it decides, but reliability and durability are what all publishers offer"
)
