# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What the page of `manycore view` shows with the clouds of a topic: a map and a judgement."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from typing import Any

from rmw_manycore_py.cli.topic.cloud_samples import Row, judgement_of
from rmw_manycore_py.cli.topic.listening import Listener, offered_policies
from rmw_manycore_py.cli.topic.map_search import CLOUD, MapSearch
from rmw_manycore_py.cli.topic.qos_options import QosOptions
from rmw_manycore_py.native._transport import EndpointInfo, Platform
from rmw_manycore_py.ros.names import expand, full_node_name

_DIAGNOSTICS = ("/diagnostics", "diagnostic_msgs/msg/DiagnosticArray")
_ALL_REPORTS = QosOptions(depth=100)  # also of the time that a large cloud takes
LOOK_PERIOD_S = 0.5
_STATUS = "scan_matching_status"  # of Autoware's matcher and ours


class Surroundings:
    """Subscribes to what is shown with the clouds of a topic: a latched map, a matcher's report.

    Reads the registry only after nodes or endpoints have come or gone.
    """

    def __init__(
        self, listener: Listener, platform: Platform, topic: str, show: Callable[[Row], None]
    ) -> None:
        self._listener, self._platform = listener, platform
        self._topic, self._show = expand(topic, "/"), show
        self._generation: int | None = None  # of the graph that was read
        self._map, self._map_topics = MapSearch(listener, show), list[str]()
        self._has_reports = False
        self._reporting: Counter[str] = Counter()  # nodes by name without namespace
        self._own_names: set[str] = set()  # of nodes that report and publish the clouds
        listener.every(LOOK_PERIOD_S, self._look)

    def belong_to(self, frame: str) -> None:
        """Look for a map in the frame of the clouds from now on."""
        self._map.belong_to(frame)

    def _look(self) -> None:
        self._follow_graph()
        self._map.look(self._map_topics)

    def _follow_graph(self) -> None:
        generation = self._platform.graph_generation()
        if generation == self._generation:
            return
        self._generation = generation
        endpoints = self._platform.endpoints()
        publishers = [e for e in endpoints if (e.kind, e.role) == ("publisher", "topic")]
        own = {_node(e) for e in publishers if e.topic == self._topic}
        self._map_topics = _latched_clouds(publishers, self._topic, own)
        reporting = {_node(e) for e in publishers if (e.topic, e.type) == _DIAGNOSTICS}
        self._reporting = Counter(map(_base_name, reporting))
        self._own_names = set(map(_base_name, reporting & own))
        if self._own_names and not self._has_reports:
            self._has_reports = True
            self._listener.also(*_DIAGNOSTICS, self._on_report, _ALL_REPORTS)

    def _on_report(self, message: Any) -> None:
        self._follow_graph()  # it may be the first report of another matcher
        for status in message.status:
            name, _, kind = status.name.partition(": ")
            if kind == _STATUS and name in self._own_names:
                self._show({"judgement": self._judgement(name, status)})

    def _judgement(self, name: str, status: Any) -> Row:
        # A report names its node without the namespace, and rclpy does not tell the publisher.
        if self._reporting[name] > 1:
            return {"text": f"unknown: several nodes are named '{name}'", "believed": False}
        return judgement_of(status)


def _latched_clouds(publishers: list[EndpointInfo], topic: str, nodes: set[str]) -> list[str]:
    """Return the topics of other latched clouds, those of these nodes last."""
    others = [e for e in publishers if e.type == CLOUD and e.topic != topic]
    topics = {(_node(other) in nodes, other.topic) for other in others}
    names = dict.fromkeys(name for _, name in sorted(topics))
    return [name for name in names if offered_policies(o for o in others if o.topic == name)[1]]


def _node(endpoint: EndpointInfo) -> str:
    return full_node_name(endpoint.node_namespace, endpoint.node_name)


def _base_name(node: str) -> str:
    return node.rpartition("/")[2]
