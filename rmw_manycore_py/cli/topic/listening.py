# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Subscribe to one topic, for `topic echo`, `hz`, `bw` and `delay`."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator
from functools import partial
from inspect import signature
from typing import Any

from rmw_manycore_py.cli.common import view
from rmw_manycore_py.cli.common.interface_types import load_type
from rmw_manycore_py.cli.common.printing import echo, print_notices
from rmw_manycore_py.cli.common.tool_node import tool_node
from rmw_manycore_py.cli.topic.qos_options import QosOptions
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.errors.suggestions import did_you_mean
from rmw_manycore_py.native._transport import EndpointInfo
from rmw_manycore_py.platform.virtual_clock import virtual_clock
from rmw_manycore_py.process.spinning import spin_once
from rmw_manycore_py.ros.names import expand
from rmw_manycore_py.ros.qos import all_reliable, all_transient_local

ANY_QOS = QosOptions()


class Listener:
    """Subscribes to a topic of a platform with the QoS its publishers offer.

    Calls `heard` with each message, plus rclpy's message info if it takes two arguments; `lost`
    with the status of each message-lost event; `subscribed` with the full topic name once
    subscribed. With `waits`, waits for a topic that does not exist yet; otherwise its type is
    required.
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
        sim_time: bool = False,
        waits: bool = False,
        subscribed: Callable[[str], None] | None = None,
    ) -> None:
        self._platform, self._topic = platform, expand(topic, "/")
        self._qos, self._sim_time, self._type_name = qos, sim_time, type_name
        self._heard, self._lost, self._raw = heard, lost, raw
        self._subscribed = subscribed
        self._timers: list[tuple[float, Callable[[], None]]] = []
        self._over = False
        self._node: Any = None
        self._clock: Any = None
        self._published_s: float | None = None  # the newest message, in a run in virtual time
        if not waits:
            self.message_type()

    def every(self, period_s: float, call: Callable[[], None]) -> None:
        """Call a function once per period."""
        self._timers.append((period_s, call))

    def stop(self) -> None:
        """End `run` after the current message."""
        self._over = True

    def message_type(self) -> Any:
        """Return the class of the messages; raise ManycoreError if it cannot be known."""
        if self._type_name:
            return load_type(self._type_name)
        endpoints = _endpoints(self._platform, self._topic)
        return load_type(type_of_topic(self._topic, endpoints, _topics(self._platform)))

    def now_s(self) -> float:
        """Return the time used for measuring in seconds: simulated, virtual, or since 1970."""
        if self._published_s is not None:
            return self._published_s
        return float(self._clock.now().nanoseconds * 1e-9)

    def run(self, timeout_s: float | None = None, *, until_ctrl_c: bool = True) -> None:
        """Spin until stopped, timed out or interrupted.

        An interrupt raises KeyboardInterrupt only without `until_ctrl_c`.
        """
        with tool_node(self._platform, sim_time=self._sim_time, until_ctrl_c=until_ctrl_c) as node:
            self._node, self._clock = node, node.get_clock()
            self._wait_for_topic(node)
            self._subscribe(node)
            if self._subscribed:
                self._subscribed(self._topic)
            for period_s, call in self._timers:
                node.create_timer(period_s, call)
            end_s = float("inf") if timeout_s is None else time.monotonic() + timeout_s
            while not self._over and time.monotonic() < end_s:
                spin_once(node, max(end_s - time.monotonic(), 0))

    def also(
        self, topic: str, type_name: str, heard: Callable[[Any], None], qos: QosOptions
    ) -> Callable[[], None]:
        """Subscribe to another topic, too; only while running. Returns what cancels that."""
        reliable, kept = offered_policies(_endpoints(self._platform, topic))
        profile = qos.profile(reliable=reliable, kept=kept)
        made = self._node.create_subscription(load_type(type_name), topic, heard, profile)
        return partial(self._node.destroy_subscription, made)

    def _wait_for_topic(self, node: Any) -> None:
        endpoints = _endpoints(self._platform, self._topic)
        if not any(endpoint.kind == "publisher" for endpoint in endpoints):
            meant = "" if endpoints else did_you_mean(self._topic, _topics(self._platform))
            text = f"WARNING: topic [{self._topic}] does not appear to be published yet{meant}"
            echo(text, err=True)
        while not self._type_name and not _endpoints(self._platform, self._topic):
            spin_once(node)

    def _subscribe(self, node: Any) -> None:
        from rclpy.event_handler import SubscriptionEventCallbacks

        # Request no stronger QoS than every publisher offers, so that all match.
        endpoints = _endpoints(self._platform, self._topic)
        print_notices(mixed_offers(endpoints, self._qos))
        reliable, kept = offered_policies(endpoints)
        is_virtual = not self._sim_time and virtual_clock(self._platform) is not None
        node.create_subscription(
            self.message_type(),
            self._topic,
            self._noting_time if is_virtual else self._heard,
            self._qos.profile(reliable=reliable, kept=kept),
            event_callbacks=SubscriptionEventCallbacks(message_lost=self._lost),
            raw=self._raw,
        )

    def _noting_time(self, message: Any, info: Any) -> None:
        """Take the time of a publication: this process lives in wall time."""
        self._published_s = info["source_timestamp"] * 1e-9
        takes_info = len(signature(self._heard).parameters) > 1
        self._heard(*((message, info) if takes_info else (message,)))


def type_of_topic(topic: str, endpoints: Iterable[EndpointInfo], known: Iterable[str] = ()) -> str:
    """Return the single type of a topic; `known` are the names of all topics."""
    types = sorted({endpoint.type for endpoint in endpoints})
    if not types:
        meant = did_you_mean(topic, known) or "; give its type to wait for it"
        raise ManycoreError(
            f"Could not determine the type for the passed topic: nothing uses '{topic}' yet{meant}"
        )
    if len(types) > 1:
        raise ManycoreError(f"'{topic}' has several types, give one: {', '.join(types)}")
    return types[0]


def _endpoints(platform: str, topic: str) -> list[EndpointInfo]:
    if platform not in view.platform_names():
        return []
    return view.endpoints_of_topic(view.endpoints_on(platform), topic)


def _topics(platform: str) -> list[str]:
    if platform not in view.platform_names():
        return []
    return [row["name"] for row in view.topics(view.endpoints_on(platform), hidden=True)]


def offered_policies(endpoints: Iterable[EndpointInfo]) -> tuple[bool | None, bool | None]:
    """Return whether all publishers of a topic are reliable, and whether all are transient local.

    Both are None without publishers.
    """
    offers = [e.qos for e in endpoints if e.kind == "publisher"]
    if not offers:
        return None, None
    return all_reliable(offers), all_transient_local(offers)


def mixed_offers(endpoints: Iterable[EndpointInfo], asked: QosOptions) -> Iterator[str]:
    """Yield notices about policies that only some publishers of a topic offer."""
    offers = [e.qos for e in endpoints if e.kind == "publisher"]
    policies = (
        (asked.reliability, {qos.reliability for qos in offers}, "reliable", "best_effort"),
        (asked.durability, {qos.durability for qos in offers}, "transient_local", "volatile"),
    )
    for wanted, offered, strong, weak in policies:
        if wanted is None and len(offered) > 1:
            yield f"some, but not all, publishers offer {strong}; requesting {weak} to match all"
