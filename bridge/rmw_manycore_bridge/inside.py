# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Platform side of the bridge: joins the platform through the transport binding, without rmw."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from rmw_manycore_bridge.outside.loop import Loop
from rmw_manycore_py.native import _transport
from rmw_manycore_py.native._transport import EndpointInfo
from rmw_manycore_py.native.enums import EndpointKind, EndpointRole
from rmw_manycore_py.routes.plan import Plan
from rmw_manycore_py.routes.route import DIRECTIONS

NODE_PREFIX = "_manycore_bridge_"  # hidden node name; goes on with engine, direction and lane


class InsideReader(Protocol):
    """Entity that receives messages from the platform."""

    def pump_inside(self) -> None:
        """Forward messages that have arrived."""


class Inside(Loop):
    """Thread that blocks on the process's common wake word."""

    def __init__(self, plan: Plan, core: tuple[int, int], name: str, changed: Callable[[], None]):
        super().__init__("inside")
        self._own = tuple(NODE_PREFIX + plan.outside.stem(way) for way in DIRECTIONS)
        cluster, core_number = core
        self.process = _transport.Process(plan.platform, cluster, core_number, name)
        self.process.watch_graph()
        self.readers: list[InsideReader] = []
        self._changed = changed
        self._generation = self.process.graph_generation()

    def publishers(self, topic: str) -> list[EndpointInfo]:
        """Return the publishers of a topic, except the bridge's."""
        return self._endpoints(topic, "topic", "publisher")

    def subscriptions(self, topic: str) -> list[EndpointInfo]:
        """Return the subscriptions of a topic, except the bridge's."""
        return self._endpoints(topic, "topic", "subscription")

    def published(self, wanted: Callable[[str], bool]) -> dict[str, frozenset[str]]:
        """Return the types published by others than the bridge, by topic name."""
        return self._types("topic", "publisher", wanted)

    def served(self, wanted: Callable[[str], bool]) -> dict[str, frozenset[str]]:
        """Return the types of services with a server that is not the bridge's, by name."""
        return self._types("request", "subscription", wanted)

    def servers(self, service: str) -> list[EndpointInfo]:
        """Return the servers of a service, except the bridge's."""
        return self._endpoints(service, "request", "subscription")

    def _types(
        self, role: EndpointRole, kind: EndpointKind, wanted: Callable[[str], bool]
    ) -> dict[str, frozenset[str]]:
        found: dict[str, set[str]] = {}
        for endpoint in self.process.endpoints():
            if self._is_of_others(endpoint, role, kind) and wanted(endpoint.topic):
                found.setdefault(endpoint.topic, set()).add(endpoint.type)
        return {name: frozenset(types) for name, types in found.items()}

    def _endpoints(self, name: str, role: EndpointRole, kind: EndpointKind) -> list[EndpointInfo]:
        return [
            endpoint
            for endpoint in self.process.endpoints_of(name)
            if self._is_of_others(endpoint, role, kind)
        ]

    def _is_of_others(self, endpoint: EndpointInfo, role: EndpointRole, kind: EndpointKind) -> bool:
        is_own = endpoint.node_name.startswith(self._own)
        return (endpoint.role, endpoint.kind) == (role, kind) and not is_own

    def wake(self) -> None:
        """Interrupt the current or next wait. Thread-safe."""
        self.process.notify()

    def turn(self, timeout_s: float | None) -> None:
        """Forward messages that have arrived, then block until something changes."""
        seen = self.process.epoch()
        # Setters wake this thread after setting a flag. If the wake word changes after we read it,
        # the wait returns; if it changed before, we see the flag.
        if self._stale or self._stopping:
            return
        for reader in list(self.readers):
            reader.pump_inside()
        generation = self.process.graph_generation()
        if generation != self._generation:
            self._generation = generation
            self._changed()
        self.process.wait(seen, timeout_s)

    def close(self) -> None:
        """Leave the platform, after the movers have destroyed their endpoints."""
        self.readers.clear()
        self.process.close()
