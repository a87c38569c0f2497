# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A DDS domain as the outside of the bridge."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Mapping
from pathlib import Path

from rmw_manycore_bridge.fastdds.domain import Domain
from rmw_manycore_bridge.fastdds.network import has_interface
from rmw_manycore_bridge.fastdds.policies import from_rclpy
from rmw_manycore_bridge.fastdds.services import DdsClient, DdsServer
from rmw_manycore_bridge.fastdds.topics import DdsPublisher, DdsSubscription
from rmw_manycore_bridge.fastdds.transports import NOTICE, avoid_shared_memory
from rmw_manycore_bridge.outside import types
from rmw_manycore_bridge.outside.interface import Endpoint, Joining, Outside
from rmw_manycore_py.native._transport import Qos
from rmw_manycore_py.routes.route import Route

_NO_NETWORK = "no network interface is up: nothing is bridged; run 'ip link set lo up' and restart"


class FastDds(Outside):
    """Thread that waits for messages and graph changes in a DDS domain."""

    def __init__(self, number: int, domain: Domain) -> None:
        super().__init__(f"domain {number}")
        self._domain = domain
        self.readers = domain.readers

    @classmethod
    def open(cls, joining: Joining) -> FastDds:
        """Join a domain."""
        made = Domain(joining.domain, joining.name, joining.changed, joining.is_own)
        return cls(joining.domain, made)

    @classmethod
    def prepare(cls, scratch: Path, replaces: bool) -> None:
        """Choose transports, and check for a network."""
        if replaces and avoid_shared_memory(os.environ, scratch):
            print(NOTICE, file=sys.stderr, flush=True)
        if not has_interface():
            print(_NO_NETWORK, file=sys.stderr, flush=True)

    def require_type(self, name: str) -> None:
        """Raise ImportError unless the type is installed."""
        types.load(name)

    def publishers(self, route: Route, _: bool) -> list[Endpoint]:
        """Return the publishers of a topic, except this bridge's."""
        return [
            Endpoint(info.topic_type, from_rclpy(info.qos_profile))
            for info in self._domain.publishers(route.outside)
        ]

    def published(self, wanted: Callable[[str], bool]) -> Mapping[str, frozenset[str]]:
        """Return the types published by others than this bridge, by topic name."""
        return self._domain.published(wanted)

    def server_types(self, service: str) -> list[str]:
        """Return the types of a service's servers, except this bridge's."""
        return self._domain.server_types(service)

    def subscribe(self, route: Route, qos: Qos) -> DdsSubscription:
        """Subscribe to a topic."""
        return DdsSubscription(self._domain, route, qos)

    def publish(self, route: Route, qos: Qos) -> DdsPublisher:
        """Create a publisher."""
        return DdsPublisher(self._domain, route, qos)

    def serve(self, route: Route) -> DdsServer:
        """Offer a service, on a node of the route's name if it has one."""
        return DdsServer(self._domain, route)

    def call(self, route: Route) -> DdsClient:
        """Create a client."""
        return DdsClient(self._domain, route)

    def wake(self) -> None:
        """Interrupt the current or next wait. Thread-safe."""
        self._domain.wake()

    def turn(self, timeout_s: float | None) -> None:
        """Block until something changes, then forward what has arrived."""
        self._domain.turn(timeout_s)

    def close(self) -> None:
        """Leave the domain."""
        self._domain.close()
