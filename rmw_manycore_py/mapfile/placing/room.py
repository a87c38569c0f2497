# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Room of clusters, and those with too many nodes or too large topic DSMs."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from rmw_manycore_py.errors import Problem
from rmw_manycore_py.mapfile.placing.memory import memory_of_clusters
from rmw_manycore_py.mapfile.placing.placement import ClusterMemory, PlacedNode, TopicEntry
from rmw_manycore_py.mapfile.placing.topics import as_written, topic_table
from rmw_manycore_py.platform.texts import counted, listed, size_text
from rmw_manycore_py.platform.topology import Core, room_for_topic_dsms

if TYPE_CHECKING:
    from rmw_manycore_py.mapfile.format.mapfile import Mapfile


_MAX_NAMES = 4

Moves = Mapping[str, int]  # cluster by node


@dataclass
class Room:
    """Cores and bytes left in a cluster; negative if too many are used."""

    cluster: int
    cores: int
    size_bytes: int

    @property
    def suffices(self) -> bool:
        """Whether everything placed in the cluster fits."""
        return self.cores >= 0 and self.size_bytes >= 0


@dataclass(frozen=True)
class Placed:
    """Placed nodes, and cores of other runs on the platform."""

    mapfile: Mapfile
    nodes: Sequence[PlacedNode]
    occupied: Collection[Core] = ()

    def topics(self) -> tuple[TopicEntry, ...]:
        """Return the topic table."""
        return topic_table(self.mapfile, self.nodes)

    def memory(self) -> tuple[ClusterMemory, ...]:
        """Return the memory of the clusters."""
        return memory_of_clusters(self.mapfile.topology, self.nodes, self.topics())

    def room(self) -> list[Room]:
        """Return the room left in each cluster."""
        return [
            Room(one.cluster, self.cores_left(one.cluster), one.room - one.total)
            for one in self.memory()
        ]

    def cores_left(self, cluster: int) -> int:
        """Return the cores that are left in a cluster; negative if there are too few."""
        free = self.mapfile.topology.clusters[cluster - 1].free
        sections = self.mapfile.sections.nodes
        own = [node for node in self.nodes if node.cluster == cluster]
        chosen = {core.core for core in self.occupied if core.cluster == cluster}
        chosen |= {node.core for node in own if sections[node.name].core is not None}
        others = sum(sections[node.name].core is None for node in own)
        workers = sum(sections[node.name].workers for node in own)
        return len(set(free) - chosen) - others - workers

    def after(self, moves: Moves) -> Placed:
        """Return the same with some nodes in other clusters, on any core."""
        nodes = [replace(node, cluster=moves.get(node.name, node.cluster)) for node in self.nodes]
        sections = self.mapfile.sections
        moved = {
            name: node.model_copy(update={"cluster": moves[name], "core": None})
            for name, node in sections.nodes.items()
            if name in moves
        }
        changed = self.mapfile.with_nodes({**sections.nodes, **moved})
        return replace(self, mapfile=changed, nodes=nodes)


def check_rings(mapfile: Mapfile) -> Iterator[Problem]:
    """Yield the first topic whose ring fits no cluster."""
    max_bytes = room_for_topic_dsms(mapfile.topology.smem_size)
    for name, topic in mapfile.sections.topics.items():
        if topic.topic_dsm_size is not None and topic.topic_dsm_size > max_bytes:
            path = ("topics", name, "topic_dsm_size")
            expected = f"at most {max_bytes}, what topic DSMs may have of a cluster's local memory"
            yield mapfile.document.problem(path, expected, str(topic.topic_dsm_size))
            return


def check_room(placed: Placed, memory: Sequence[ClusterMemory]) -> Iterator[Problem]:
    """Yield one problem for each cluster with too many nodes or too large topic DSMs."""
    for cluster in memory:
        yield from _crowded(placed, cluster)


def _crowded(placed: Placed, memory: ClusterMemory) -> Iterator[Problem]:
    document = placed.mapfile.document
    cluster = placed.mapfile.topology.clusters[memory.cluster - 1]
    nodes = [node for node in placed.nodes if node.cluster == cluster.id]
    beyond = next((node.name for node in nodes if node.core >= cluster.cores), None)
    expected, found = [], []
    if beyond is not None:
        cores = len(nodes) - sum(node.core >= cluster.cores for node in nodes)
        expected.append(counted(cores, "node"))
        found.append(counted(len(nodes), "node"))
    if memory.used > memory.room:
        sizes = [f"{name} {size_text(size)}" for name, size in memory.topic_dsms.items()]
        expected.append(f"{size_text(memory.room)} of topic DSMs")
        found.append(f"{size_text(memory.used)} ({listed(sizes, _MAX_NAMES)})")
    if expected:
        largest = max(memory.topic_dsms, key=memory.topic_dsms.__getitem__, default="")
        path = (
            ("nodes", beyond)
            if beyond is not None
            else ("topics", as_written(placed.mapfile, largest), "topic_dsm_size")
        )
        text = f"at most {listed(expected)} in cluster {cluster.id}"
        yield document.problem(path, text, listed(found))
