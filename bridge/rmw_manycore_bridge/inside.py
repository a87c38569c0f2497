# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Platform side of the bridge: joins the platform through the transport binding, without rmw."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol
from weakref import WeakValueDictionary

from rmw_manycore_bridge.outside.loop import Loop
from rmw_manycore_py.native import _transport
from rmw_manycore_py.native._transport import EndpointInfo
from rmw_manycore_py.native.enums import EndpointKind, EndpointRole
from rmw_manycore_py.ros.names import full_node_name
from rmw_manycore_py.routes.plan import Plan

NODE_PREFIX = "_manycore_bridge_"  # hidden node name; goes on with engine, direction and lane


class InsideReader(Protocol):
    """Entity that receives messages from the platform."""

    def pump_inside(self) -> None:
        """Forward messages that have arrived."""


class Inside(Loop):
    """Thread that blocks on the process's common wake word."""

    def __init__(self, plan: Plan, core: tuple[int, int], name: str, changed: Callable[[], None]):
        super().__init__("inside")
        self._own_prefixes = tuple(NODE_PREFIX + stem for stem in plan.outside.stems())
        cluster, core_number = core
        self.process = _transport.Process(plan.platform, cluster, core_number, name)
        self.process.watch_graph()
        self.readers: list[InsideReader] = []
        self._own: tuple[int, frozenset[int]] = (-1, frozenset())  # see `_own_processes`
        self._stand_ins: WeakValueDictionary[str, _transport.Node] = WeakValueDictionary()
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
        endpoints = self.process.endpoints()
        own = self._own_processes()
        for endpoint in endpoints:
            if (endpoint.role, endpoint.kind) != (role, kind) or endpoint.process in own:
                continue
            if wanted(endpoint.topic):
                found.setdefault(endpoint.topic, set()).add(endpoint.type)
        return {name: frozenset(types) for name, types in found.items()}

    def _endpoints(self, name: str, role: EndpointRole, kind: EndpointKind) -> list[EndpointInfo]:
        found = self.process.endpoints_of(name)
        own = self._own_processes()
        return [e for e in found if (e.role, e.kind) == (role, kind) and e.process not in own]

    def nodes(self) -> set[str]:
        """Return the full names of nodes, except the bridge's and hidden ones."""
        found = self.process.nodes()
        own = self._own_processes()
        others = (n for n in found if n.process not in own and not n.name.startswith("_"))
        return {full_node_name(node.namespace, node.name) for node in others}

    def stand_in(self, full_name: str) -> _transport.Node:
        """Return a node that stands for one of another host, for as long as it is referred to."""
        found = self._stand_ins.get(full_name)
        if found is None:
            namespace, _, name = full_name.rpartition("/")
            found = self._stand_ins[full_name] = self.process.node(name, namespace or "/")
        return found

    def _own_processes(self) -> frozenset[int]:
        """Return the slots of the bridge's processes; each has its own node before others.

        They are kept with the generation of the graph that they are of.
        """
        generation, own = self.process.graph_generation(), self._own
        if own[0] != generation:
            nodes = self.process.nodes()
            slots = (node.process for node in nodes if node.name.startswith(self._own_prefixes))
            own = self._own = generation, frozenset(slots)
        return own[1]

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
