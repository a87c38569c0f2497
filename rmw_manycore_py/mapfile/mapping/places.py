# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Where the nodes of a placement are, by their full names."""

from __future__ import annotations

from collections.abc import Iterator

from rmw_manycore_py.mapfile import Placement
from rmw_manycore_py.mapfile.mapping.crossing import Publication
from rmw_manycore_py.platform.topology import Core
from rmw_manycore_py.ros.domain import is_elsewhere
from rmw_manycore_py.ros.names import full_node_name
from rmw_manycore_py.routes.route import Direction

_BRIDGE = "/_manycore_bridge_"  # its nodes go on with the engine and the direction


class Places:
    """Places of the nodes; a component is where its container is."""

    def __init__(self, placement: Placement) -> None:
        self._bridge = placement.bridge
        self._nodes = [node for node in placement.nodes if not is_elsewhere(node.env)]
        self.cores = {node.full_name: node.place for node in self._nodes}
        for node in self._nodes:
            for one in node.rules.components:
                if one.name:
                    self.cores[full_node_name(one.namespace, one.name)] = node.place

    def core(self, node: str) -> Core | None:
        """Return the core of a node or of the bridge."""
        if self._bridge is not None and node.startswith(_BRIDGE):
            is_inward = "inward" in node.removeprefix(_BRIDGE)
            return self._bridge.core("inward" if is_inward else "outward", 0)
        return self.cores.get(node)

    def publications(self) -> Iterator[Publication]:
        """Yield what nodes publish as mapfile and sources say."""
        for node in self._nodes:
            yield from (Publication(topic, node.cluster) for topic in node.publish)

    def subscriptions(self) -> Iterator[tuple[str, int]]:
        """Yield topics that nodes subscribe to as mapfile and sources say, with their clusters."""
        for node in self._nodes:
            yield from ((topic, node.cluster) for topic in node.subscribe)

    def bridged(self, direction: Direction) -> Iterator[tuple[str, int]]:
        """Yield topics that the bridge publishes or subscribes to inside, with its cluster."""
        if self._bridge is None:
            return
        cluster = self._bridge.core(direction, 0).cluster
        for route in self._bridge.routes:
            if route.kind == "topic" and route.direction == direction and not route.is_pattern:
                yield route.inside, cluster
