# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Where the nodes of a profile run: what prediction knows of a placement."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from rmw_manycore_py.mapfile import ClusterMemory, Placement
from rmw_manycore_py.platform.topology import RECEIVE_THREAD_CORE, Core
from rmw_manycore_py.process.scheduling import Scheduling, priority_above
from rmw_manycore_py.ros.names import full_node_name


@dataclass(frozen=True)
class Site:
    """Place of a node's process.

    :ivar host_cpus: that it may use; empty: all.
    """

    core: Core
    host_cpus: tuple[int, ...] = ()
    scheduling: Scheduling | None = None


@dataclass(frozen=True)
class Sites:
    """Places of nodes by full name, and the mapfile's settings of topics.

    :ivar receive_cpus: host CPU of the receive thread of each cluster.
    :ivar receive_priorities: real-time priority of the receive thread of each cluster; 0 = none.
    :ivar depths: queue depths of subscriptions by node and topic, where sources tell.
    :ivar rings: bytes of each topic DSM of fixed size, by topic.
    :ivar transferred: topics that are copied to other clusters before their readers are notified.
    :ivar memory: of each cluster when nodes have started, if it is known.
    """

    nodes: Mapping[str, Site]
    receive_cpus: Mapping[int, int] = field(default_factory=dict)
    receive_priorities: Mapping[int, int] = field(default_factory=dict)
    depths: Mapping[tuple[str, str], int] = field(default_factory=dict)
    rings: Mapping[str, int] = field(default_factory=dict)
    transferred: frozenset[str] = frozenset()
    memory: tuple[ClusterMemory, ...] = ()
    bridge: Mapping[str, Site] = field(default_factory=dict)  # by direction

    def scheduled(self, scheduling: Scheduling) -> Sites:
        """Return the places with all nodes and receive threads scheduled like this."""
        nodes = {name: replace(one, scheduling=scheduling) for name, one in self.nodes.items()}
        priorities = dict.fromkeys(self.receive_priorities, priority_above([scheduling]))
        return replace(self, nodes=nodes, receive_priorities=priorities)

    def of(self, node: str) -> Site | None:
        """Return the place of a node or of a bridge's node."""
        site = self.nodes.get(node)
        if site is None and node.startswith(_BRIDGE):
            is_inward = node.removeprefix(_BRIDGE).startswith("inward")
            return self.bridge.get("inward" if is_inward else "outward")
        return site


_BRIDGE = "/_manycore_bridge_"  # its nodes go on with the direction


def sites_of(placement: Placement) -> Sites:
    """Return the places of a placement's nodes; a component is where its container is."""
    nodes: dict[str, Site] = {}
    depths: dict[tuple[str, str], int] = {}
    for node in placement.nodes:
        site = Site(node.place, (node.host_cpu,), node.scheduling)
        nodes[node.full_name] = site
        for one in node.rules.components:
            if one.name:
                nodes[full_node_name(one.namespace, one.name)] = site
        for (key, topic), depth in node.depths.items():
            if key == "subscribe":
                depths[node.full_name, topic] = depth
    clusters = {one.id for one in placement.topology.clusters}
    receivers = {cluster: Core(cluster, RECEIVE_THREAD_CORE) for cluster in clusters}
    bridge = placement.bridge
    return Sites(
        nodes=nodes,
        receive_cpus={
            cluster: placement.host_cpus[core]
            for cluster, core in receivers.items()
            if core in placement.host_cpus
        },
        receive_priorities={
            one: placement.receive_priority(one, Scheduling("other")) for one in clusters
        },
        depths=depths,
        rings={one.name: one.topic_dsm_size for one in placement.topics if one.topic_dsm_size},
        transferred=frozenset(one.name for one in placement.topics if one.transfer != "dsm"),
        memory=placement.memory,
        bridge={
            direction: Site(bridge.core(direction, 0), bridge.host_cpus)
            for direction in ("inward", "outward")
        }
        if bridge
        else {},
    )
