# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Subscription in a DDS domain, for `topic echo --outside`: the external view of a platform."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Sequence
from typing import Any

from rmw_manycore_hook import restart
from rmw_manycore_py.cli.common.interface_types import load_type
from rmw_manycore_py.cli.common.tool_node import any_node
from rmw_manycore_py.cli.topic.qos_options import QosOptions
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.launch.processes.environment import OUTSIDE_IMPLEMENTATION, outside_environment
from rmw_manycore_py.process.signals import interrupts_held
from rmw_manycore_py.process.spinning import spin_once
from rmw_manycore_py.ros.names import expand


class OutsideListener:
    """Subscribes once the topic has a publisher in $ROS_DOMAIN_ID."""

    def __init__(
        self,
        topic: str,
        type_name: str | None,
        heard: Callable[..., None],
        *,
        raw: bool,
        qos: QosOptions,
    ) -> None:
        leave_middleware()
        self._topic, self._type_name = expand(topic, "/"), type_name
        self._heard, self._raw, self._qos = heard, raw, qos
        self._over = False

    def stop(self) -> None:
        """End `run` after the current message."""
        self._over = True

    def run(self, timeout_s: float | None = None, *, until_ctrl_c: bool = True) -> None:
        """Spin until stopped, timed out or interrupted.

        An interrupt raises KeyboardInterrupt only without `until_ctrl_c`.
        """
        end_s = float("inf") if timeout_s is None else time.monotonic() + timeout_s
        with any_node(until_ctrl_c=until_ctrl_c) as node:
            listens = False
            while not self._over and time.monotonic() < end_s:
                with interrupts_held():
                    listens = listens or self._subscribe(node)
                spin_once(node)

    def _subscribe(self, node: Any) -> bool:
        publishers = node.get_publishers_info_by_topic(self._topic)
        if publishers:
            message_type = load_type(self._type_name or _type_of(self._topic, publishers))
            qos = self._profile([publisher.qos_profile for publisher in publishers])
            node.create_subscription(message_type, self._topic, self._heard, qos, raw=self._raw)
        return bool(publishers)

    def _profile(self, offers: Sequence[Any]) -> Any:
        from rclpy.qos import DurabilityPolicy, ReliabilityPolicy

        return self._qos.profile(
            reliable=all(o.reliability == ReliabilityPolicy.RELIABLE for o in offers),
            kept=all(o.durability == DurabilityPolicy.TRANSIENT_LOCAL for o in offers),
        )


def leave_middleware() -> None:
    """Re-execute this program with Fast DDS, unless it uses that already."""
    if os.environ.get("RMW_IMPLEMENTATION") != OUTSIDE_IMPLEMENTATION:
        restart(outside_environment())


def _type_of(topic: str, publishers: Sequence[Any]) -> str:
    types: list[str] = sorted({publisher.topic_type for publisher in publishers})
    if len(types) > 1:
        raise ManycoreError(f"'{topic}' has several types, give one: {', '.join(types)}")
    return types[0]
