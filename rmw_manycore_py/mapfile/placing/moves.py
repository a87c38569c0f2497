# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Where the nodes of crowded clusters would fit."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import Any

from rmw_manycore_py.errors import MapfileError, Problem
from rmw_manycore_py.mapfile.placing.memory import share_of_node
from rmw_manycore_py.mapfile.placing.placement import PlacedNode
from rmw_manycore_py.mapfile.placing.room import Moves, Placed, Room
from rmw_manycore_py.mapfile.placing.sessions import check_sessions
from rmw_manycore_py.platform.smem import Smem
from rmw_manycore_py.platform.texts import counted, listed, size_text

_MAX_ROOMS = 5  # groups of clusters in words


class RoomError(MapfileError):
    """Problems of a mapfile that places more in a cluster than it has room for."""

    def __init__(self, problems: Sequence[Problem], advice: Proposal) -> None:
        super().__init__(*problems, hints=advice.lines())
        self.advice = advice


@dataclass(frozen=True)
class Proposal:
    """Where nodes of crowded clusters would fit.

    :param placed: nodes and foreign cores.
    :param room: room left in each cluster that has some.
    :param moves: nodes to move, each with the cluster where it fits; empty if no way was found.
    """

    placed: Placed
    room: Sequence[Room]
    moves: Moves

    @classmethod
    def of(cls, placed: Placed) -> Proposal:
        """Look for room."""
        room = [one for one in placed.room() if one.cores > 0 and one.size_bytes > 0]
        return cls(placed, room, moves_for(placed))

    def lines(self) -> Iterator[str]:
        """Yield the moves in words."""
        rooms = listed([*_rooms_in_words(self.room)], _MAX_ROOMS)
        yield f"room is left in {rooms}" if rooms else "no cluster has room"
        if not self.moves:
            yield f"no way to move nodes was found: {self._instead()}, or take a larger platform"
            return
        sections = self.placed.mapfile.sections.nodes
        by_cluster: dict[int, list[str]] = defaultdict(list)
        for name in sections:
            if name in self.moves:
                by_cluster[self.moves[name]].append(name)
        parts = [f"{listed(names)} to cluster {one}" for one, names in sorted(by_cluster.items())]
        with_core = sum(sections[name].core is not None for name in self.moves)
        without = ("", ", without its core")[with_core] if with_core < 2 else ", without their core"
        yield f"it fits if you move {'; '.join(parts)}{without}"

    def _instead(self) -> str:
        if any(one.cores < 0 for one in self.placed.room()):
            return "let nodes share a core (core, allow_shared_cores)"
        return "lower topic_dsm_size"

    def data(self) -> dict[str, Any]:
        """Return the moves as JSON data."""
        return {"room": [vars(one) for one in self.room], "moves": dict(self.moves)}


def _rooms_in_words(room: Sequence[Room]) -> Iterator[str]:
    """Yield the clusters, neighbours with equal room together."""
    for (cores, size_bytes), group in groupby(room, lambda one: (one.cores, one.size_bytes)):
        equal = [one.cluster for one in group]
        is_run = len(equal) > 2 and equal[-1] - equal[0] == len(equal) - 1
        numbers = f"{equal[0]} to {equal[-1]}" if is_run else listed([*map(str, equal)])
        each = " each" if len(equal) > 1 else ""
        clusters = "clusters" if each else "cluster"
        yield f"{clusters} {numbers} ({counted(cores, 'core')}, {size_text(size_bytes)}{each})"


def moves_for(placed: Placed) -> dict[str, int]:
    """Return nodes to move so that all clusters have room; empty if no way was found.

    The largest nodes leave a cluster without memory, the last ones a cluster without cores. A node
    goes where most nodes are with which it shares topics.
    """
    moves = _Search(placed).moves
    after = placed.after(moves)
    fits = all(one.suffices for one in after.room())
    return moves if fits and not [*check_sessions(after.mapfile, after.topics())] else {}


class _Search:
    """Moves nodes, one after the other, out of crowded clusters."""

    def __init__(self, placed: Placed) -> None:
        self.moves: dict[str, int] = {}
        self._placed = placed
        self._table = {topic.name: topic for topic in placed.topics()}
        room = placed.room()
        self._targets = [one for one in room if one.suffices]
        for one in room:
            if not one.suffices:
                self._empty(one)

    def _empty(self, crowded: Room) -> None:
        own = [node for node in self._placed.nodes if node.cluster == crowded.cluster]
        needs = {node.name: self._need(node) for node in own}
        own.reverse()
        while own and not crowded.suffices:
            is_full = crowded.size_bytes < 0
            node = max(own, key=lambda one: needs[one.name].size_bytes) if is_full else own[0]
            own.remove(node)
            need = needs[node.name]
            target = self._target(node, need)
            if target is not None:
                self.moves[node.name] = target.cluster
                target.cores -= need.cores
                target.size_bytes -= need.size_bytes
                crowded.cores += need.cores
                crowded.size_bytes += need.size_bytes

    def _need(self, node: PlacedNode) -> Room:
        cluster = self._placed.mapfile.topology.clusters[node.cluster - 1]
        share = share_of_node(Smem(cluster.smem_size), node, self._table)
        workers = self._placed.mapfile.sections.nodes[node.name].workers
        return Room(node.cluster, 1 + workers, share.total)

    def _target(self, node: PlacedNode, need: Room) -> Room | None:
        fitting = [
            one
            for one in self._targets
            if one.cores >= need.cores and one.size_bytes >= need.size_bytes
        ]
        return max(
            fitting, key=lambda one: (self._partners(node, one.cluster), one.cores), default=None
        )

    def _partners(self, node: PlacedNode, cluster: int) -> int:
        """Return how many nodes of a cluster share a topic with this one."""
        partners = {
            other.name
            for name in (*node.publish, *node.subscribe)
            for other in (*self._table[name].publishers, *self._table[name].subscribers)
            if self.moves.get(other.name, other.cluster) == cluster
        }
        return len(partners - {node.name})
