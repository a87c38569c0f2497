# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Listening to one topic, for `topic echo`, `hz`, `bw` and `delay`."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from typing import Any

from rmw_manycore_py._transport import EndpointInfo
from rmw_manycore_py.cli.common import view
from rmw_manycore_py.cli.common.interface_types import load_type
from rmw_manycore_py.cli.common.tool_node import spin_once, tool_node
from rmw_manycore_py.cli.topic.qos_options import QosOptions
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.ros.names import expand

ANY_QOS = QosOptions()


class Listener:
    """Subscribes to a topic of a platform, as its publishers offer it.

    `heard` is called with each message, and with what rclpy knows of it if it takes two arguments;
    `lost` with the status of each event of lost messages.
    """

    def __init__(
        self,
        platform: str,
        topic: str,
        type_name: str | None,
        heard: Callable[..., None],
        *,
        lost: Callable[[Any], None] | None = None,
        raw: bool = False,
        qos: QosOptions = ANY_QOS,
    ) -> None:
        topic = expand(topic, "/")
        self._endpoints, self._qos = _endpoints(platform, topic), qos
        self._message_type = load_type(type_name or type_of_topic(topic, self._endpoints))
        self._platform, self._topic = platform, topic
        self._heard, self._lost, self._raw = heard, lost, raw
        self._timers: list[tuple[float, Callable[[], None]]] = []
        self._over = False

    def every(self, period_s: float, call: Callable[[], None]) -> None:
        """Call something once per period."""
        self._timers.append((period_s, call))

    def stop(self) -> None:
        """End `run` after the present message."""
        self._over = True

    def run(self, timeout_s: float | None = None) -> None:
        """Listen until stopped or interrupted, or until the time is over."""
        from rclpy.event_handler import SubscriptionEventCallbacks

        # No more than every publisher offers, so that all are heard.
        reliable, kept = offered_policies(self._endpoints)
        with tool_node(self._platform) as node:
            qos = self._qos.profile(reliable=reliable, kept=kept)
            node.create_subscription(
                self._message_type,
                self._topic,
                self._heard,
                qos,
                event_callbacks=SubscriptionEventCallbacks(message_lost=self._lost),
                raw=self._raw,
            )
            for period_s, call in self._timers:
                node.create_timer(period_s, call)
            end_s = float("inf") if timeout_s is None else time.monotonic() + timeout_s
            while not self._over and time.monotonic() < end_s:
                spin_once(node, max(end_s - time.monotonic(), 0))


def type_of_topic(topic: str, endpoints: Iterable[EndpointInfo]) -> str:
    """Return the one type of a topic."""
    types = sorted({endpoint.type for endpoint in endpoints})
    if not types:
        raise ManycoreError(f"nobody uses the topic '{topic}' yet; give its type to wait for it")
    if len(types) > 1:
        raise ManycoreError(f"'{topic}' has several types, give one: {', '.join(types)}")
    return types[0]


def _endpoints(platform: str, topic: str) -> list[EndpointInfo]:
    if platform not in view.platform_names():
        return []
    return view.endpoints_of_topic(view.endpoints_on(platform), topic)


def offered_policies(endpoints: Iterable[EndpointInfo]) -> tuple[bool, bool]:
    """Return whether all publishers of a topic are reliable, and whether all keep messages."""
    offers = [e.qos for e in endpoints if e.kind == "publisher"]
    reliable = all(qos.reliability == "reliable" for qos in offers)
    kept = bool(offers) and all(qos.durability == "transient_local" for qos in offers)
    return reliable, kept
