# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Memory that a run takes of each cluster when its nodes have started."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from rmw_manycore_py.mapfile.placing.placement import ClusterMemory, PlacedNode, TopicEntry
from rmw_manycore_py.platform.smem import Smem
from rmw_manycore_py.platform.topology import Topology


@dataclass
class Share:
    """Part of a cluster's memory, in bytes."""

    fixed: Counter[str] = field(default_factory=Counter)
    nodes: int = 0
    queues: int = 0
    growing: set[str] = field(default_factory=set)

    @property
    def total(self) -> int:
        """All of it."""
        return self.fixed.total() + self.nodes + self.queues

    def add_publisher(self, smem: Smem, topic: str, depth: int, entry: TopicEntry | None) -> None:
        """Add a topic DSM."""
        ring = entry.topic_dsm_size if entry else None
        transferred = entry is not None and entry.transfer != "dsm"
        self.nodes += smem.publisher(depth, ring, transferred=transferred) - (ring or 0)
        if ring is None:
            self.growing.add(topic)
        else:
            self.fixed[topic] += ring

    def add(self, other: Share) -> None:
        """Add another part."""
        self.fixed.update(other.fixed)
        self.nodes += other.nodes
        self.queues += other.queues
        self.growing |= other.growing


def share_of_node(smem: Smem, node: PlacedNode, table: Mapping[str, TopicEntry]) -> Share:
    """Return what a node takes in its own cluster."""
    share = Share(nodes=(1 + len(node.rules.components)) * smem.node)
    for topic in node.publish:
        share.add_publisher(smem, topic, node.depth("publish", topic), table.get(topic))
    share.queues = sum(smem.subscription(node.depth("subscribe", name)) for name in node.subscribe)
    return share


def memory_of_clusters(
    topology: Topology,
    nodes: Sequence[PlacedNode],
    topics: Sequence[TopicEntry],
) -> tuple[ClusterMemory, ...]:
    """Return the memory of all clusters; a ring counts once for each of its publishers."""
    shares = {cluster.id: Share() for cluster in topology.clusters}
    smem = {cluster.id: Smem(cluster.smem_size) for cluster in topology.clusters}
    table = {topic.name: topic for topic in topics}
    for node in nodes:
        shares[node.cluster].add(share_of_node(smem[node.cluster], node, table))
    for topic in topics:
        for node, receiver in topic.landings if topic.topic_dsm_size else ():
            size = topic.topic_dsm_size or 0
            landing = smem[receiver].landing(node.depth("publish", topic.name), size)
            shares[receiver].add(Share(Counter({topic.name: size}), landing - size))
    return tuple(
        ClusterMemory(
            number,
            smem[number].size,
            dict(share.fixed),
            share.nodes + (smem[number].head if share.total else 0),
            share.queues,
            tuple(sorted(share.growing)),
        )
        for number, share in shares.items()
    )
