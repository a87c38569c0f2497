# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Contents of each cluster's picture, before anything has a place."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from rmw_manycore_py.platform.monitor.graph import Graph, Member

# With more cores, only those in use are drawn.
MAX_EMPTY_CORES = 16
MAX_NODES_OF_CELL = 8
CELL_HEAD = 18.0
NODE_HEIGHT = 20.0
WORKER_SIDE = 8.0
GAP = 6.0
_MAX_COLUMNS = 4
_MANY_CELLS = 32


@dataclass(frozen=True)
class CellPlan:
    """A core in use, or a process without a core."""

    cluster: int
    core: int | None
    living: tuple[Member, ...]
    dead: tuple[Member, ...]
    workers: tuple[int, ...]  # pids

    @property
    def id(self) -> str:
        """Element id."""
        first = (self.living + self.dead)[0]
        own = f"{self.core}" if self.core is not None else f"p{first.slot}-{first.pid}"
        return f"c{self.cluster}-{own}"

    @property
    def names(self) -> list[tuple[str, Member, bool]]:
        """Its nodes: name, process, and whether the process is dead."""
        sides = ((self.living, False), (self.dead, True))
        return [
            (name, member, is_dead)
            for members, is_dead in sides
            for member in members
            for name in member.shown_names
        ]

    @property
    def height(self) -> float:
        """Required height."""
        count = len(self.names)
        rows = min(count, MAX_NODES_OF_CELL) + (count > MAX_NODES_OF_CELL)
        bottom = WORKER_SIDE + GAP if self.workers else 0.0
        return CELL_HEAD + rows * NODE_HEIGHT + bottom + 4


@dataclass(frozen=True)
class ClusterPlan:
    """A cluster: rows of cells, and the cores that are free."""

    id: int
    rows: tuple[tuple[CellPlan, ...], ...]
    free: tuple[int, ...]

    @property
    def columns(self) -> int:
        """Cells of the longest row."""
        return max((len(row) for row in self.rows), default=0)


def plan_clusters(
    graph: Graph,
    present: Iterable[int],
    dead: Sequence[Member] = (),
    workers: Mapping[int, tuple[int, ...]] | None = None,
) -> tuple[ClusterPlan, ...]:
    """Return the clusters in use.

    :param present: existing clusters, also without nodes.
    :param workers: worker pids by the pid of their coordinator.
    """
    used = {member.cluster for member in (*graph.members, *dead)} | set(present)
    return tuple(_plan(graph, cluster, dead, workers or {}) for cluster in sorted(used))


def _plan(
    graph: Graph, cluster: int, dead: Sequence[Member], workers: Mapping[int, tuple[int, ...]]
) -> ClusterPlan:
    living = [member for member in graph.members if member.cluster == cluster]
    gone = [member for member in dead if member.cluster == cluster]
    cores = sorted({member.core for member in (*living, *gone) if member.core is not None})
    groups = [([m for m in living if m.core == c], [m for m in gone if m.core == c]) for c in cores]
    groups += [([member], []) for member in living if member.core is None]
    groups += [([], [member]) for member in gone if member.core is None]
    cells = [
        CellPlan(
            cluster,
            (own + lost)[0].core,
            tuple(own),
            tuple(lost),
            tuple(pid for member in own for pid in workers.get(member.pid, ())),
        )
        for own, lost in groups
    ]
    columns = math.ceil(math.sqrt(len(cells)))
    if len(cells) <= _MANY_CELLS:
        columns = min(columns, _MAX_COLUMNS)
    rows = tuple(tuple(cells[n : n + columns]) for n in range(0, len(cells), columns or 1))
    is_small = graph.cores_per_cluster <= MAX_EMPTY_CORES
    free = tuple(sorted(set(range(graph.cores_per_cluster)) - set(cores))) if is_small else ()
    return ClusterPlan(cluster, rows, free)
