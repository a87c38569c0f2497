# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Layout of clusters, cores and nodes, as in Fig. 11 of ROS-lite2."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

from rmw_manycore_py.picture.geometry import Rect
from rmw_manycore_py.platform.monitor.graph import Graph, Member

GAP = 6.0
PAD = 12.0
CLUSTER_GAP = 72.0
HEAD = 66.0  # height of a cluster's title, SMEM bar and receive thread
CELL_HEAD = 18.0
NODE_HEIGHT = 20.0
WORKER_SIDE = 8.0
UNUSED_WIDTH, UNUSED_HEIGHT = 190.0, 34.0
# With more cores, only those in use are drawn.
MAX_EMPTY_CORES = 16
MAX_NODES_OF_CELL = 8
_WIDE, _NARROW = 132.0, 92.0
_MANY_CELLS = 32
_BRIDGE = "_manycore_bridge"  # prefix of its node names


@dataclass(frozen=True)
class NodeBox:
    """A node, or a process without nodes."""

    id: str
    name: str
    member: Member
    is_dead: bool
    rect: Rect

    @property
    def shown_name(self) -> str:
        """Displayed name; readable for bridge processes."""
        return self.name.replace(f"/{_BRIDGE}_", "bridge ")

    @property
    def kind(self) -> str:
        """Style: node, bridge, tool or process."""
        if not self.member.nodes:
            return "process"
        own_name = self.name.rpartition("/")[2]
        if own_name.startswith(_BRIDGE):
            return "bridge"
        return "tool" if own_name.startswith("_") else "node"


@dataclass(frozen=True)
class Cell:
    """A core, or a process without a core."""

    id: str
    cluster: int
    core: int | None
    members: tuple[Member, ...]
    workers: tuple[int, ...]  # pids
    nodes: tuple[NodeBox, ...]
    hidden: int  # number of nodes that do not fit
    rect: Rect

    @cached_property
    def has_dead(self) -> bool:
        """Whether one of its nodes has died."""
        return any(node.is_dead for node in self.nodes)

    @cached_property
    def cpu_id(self) -> str:
        """Element id of its CPU usage."""
        return f"{self.id}-cpu"


@dataclass(frozen=True)
class ClusterBox:
    """A cluster with its contents."""

    id: int
    is_used: bool
    cells: tuple[Cell, ...]
    rect: Rect

    @property
    def smem(self) -> Rect:
        """Rectangle of the memory bar."""
        return Rect(self.rect.x + PAD, self.rect.y + 26, self.rect.width - 2 * PAD, 10)

    @property
    def receive_thread(self) -> Rect:
        """Rectangle of the receive thread."""
        return Rect(self.rect.x + PAD, self.rect.y + 41, self.rect.width - 2 * PAD, 18)


@dataclass(frozen=True)
class Layout:
    """The picture without topics."""

    clusters: tuple[ClusterBox, ...]

    @cached_property
    def size(self) -> tuple[float, float]:
        """Width and height."""
        rects = [cluster.rect for cluster in self.clusters]
        return (
            max(rect.x + rect.width for rect in rects) + PAD,
            max(rect.y + rect.height for rect in rects) + PAD,
        )

    @cached_property
    def cells(self) -> tuple[Cell, ...]:
        """All cells."""
        return tuple(cell for cluster in self.clusters for cell in cluster.cells)

    @cached_property
    def nodes(self) -> tuple[NodeBox, ...]:
        """All drawn nodes."""
        return tuple(node for cell in self.cells for node in cell.nodes)


@dataclass(frozen=True)
class _Plan:
    """A cell before placement."""

    core: int | None
    living: tuple[Member, ...]
    dead: tuple[Member, ...]
    workers: tuple[int, ...]

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
        return CELL_HEAD + rows * NODE_HEIGHT + bottom + (4 if rows else 2)


def lay_out(
    graph: Graph,
    present: Iterable[int],
    dead: Sequence[Member] = (),
    workers: Mapping[int, tuple[int, ...]] | None = None,
) -> Layout:
    """Return the layout.

    :param present: existing clusters, also without nodes.
    :param workers: worker pids by the pid of their coordinator.
    """
    used = {member.cluster for member in (*graph.members, *dead)} | set(present)
    plans = {cluster: _plans(graph, cluster, dead, workers or {}) for cluster in sorted(used)}
    boxes: list[ClusterBox] = []
    y = PAD
    columns = max(1, math.ceil(math.sqrt(len(plans)))) if plans else 1
    clusters = sorted(plans)
    for start in range(0, len(clusters), columns):
        row = clusters[start : start + columns]
        x = PAD
        for cluster in row:
            boxes.append(_place_cluster(cluster, plans[cluster], x, y))
            x += boxes[-1].rect.width + CLUSTER_GAP
        y = max(box.rect.y + box.rect.height for box in boxes) + CLUSTER_GAP
    unused = sorted(set(range(1, graph.cluster_count + 1)) - used)
    return Layout((*boxes, *_place_unused(unused, y if boxes else PAD)))


def _plans(
    graph: Graph, cluster: int, dead: Sequence[Member], workers: Mapping[int, tuple[int, ...]]
) -> list[_Plan]:
    living = [member for member in graph.members if member.cluster == cluster]
    gone = [member for member in dead if member.cluster == cluster]
    cores = {member.core for member in (*living, *gone) if member.core is not None}
    if graph.cores_per_cluster <= MAX_EMPTY_CORES:
        cores |= set(range(graph.cores_per_cluster))
    plans = [
        _plan(
            core,
            [m for m in living if m.core == core],
            [m for m in gone if m.core == core],
            workers,
        )
        for core in sorted(cores)
    ]
    plans += [_plan(None, [member], [], workers) for member in living if member.core is None]
    plans += [_plan(None, [], [member], workers) for member in gone if member.core is None]
    return plans


def _plan(
    core: int | None,
    living: Sequence[Member],
    dead: Sequence[Member],
    workers: Mapping[int, tuple[int, ...]],
) -> _Plan:
    helpers = tuple(pid for member in living for pid in workers.get(member.pid, ()))
    return _Plan(core, tuple(living), tuple(dead), helpers)


def _place_cluster(cluster: int, plans: Sequence[_Plan], x: float, y: float) -> ClusterBox:
    is_crowded = len(plans) > _MANY_CELLS
    columns = math.ceil(math.sqrt(len(plans) / 2)) if is_crowded else 4
    width = _NARROW if is_crowded else _WIDE
    cells: list[Cell] = []
    top = y + HEAD
    for start in range(0, len(plans), columns):
        row = plans[start : start + columns]
        height = max(plan.height for plan in row)
        for column, plan in enumerate(row):
            left = x + PAD + column * (width + GAP)
            cells.append(_place_cell(cluster, plan, Rect(left, top, width, height)))
        top += height + GAP
    box = Rect(x, y, 2 * PAD + columns * (width + GAP) - GAP, top - GAP + PAD - y)
    return ClusterBox(cluster, True, tuple(cells), box)


def _place_cell(cluster: int, plan: _Plan, rect: Rect) -> Cell:
    members = plan.living + plan.dead
    own = f"{plan.core}" if plan.core is not None else f"p{members[0].slot}-{members[0].pid}"
    boxes = [
        NodeBox(
            f"n{member.pid}{name}",
            name,
            member,
            is_dead,
            Rect(
                rect.x + 4,
                rect.y + CELL_HEAD + row * NODE_HEIGHT,
                rect.width - 8,
                NODE_HEIGHT - 3,
            ),
        )
        for row, (name, member, is_dead) in enumerate(plan.names[:MAX_NODES_OF_CELL])
    ]
    return Cell(
        f"c{cluster}-{own}",
        cluster,
        plan.core,
        members,
        plan.workers,
        tuple(boxes),
        max(len(plan.names) - MAX_NODES_OF_CELL, 0),
        rect,
    )


def _place_unused(clusters: Sequence[int], y: float) -> list[ClusterBox]:
    right, down = UNUSED_WIDTH + GAP, UNUSED_HEIGHT + GAP
    return [
        ClusterBox(
            cluster,
            False,
            (),
            Rect(PAD + place % 6 * right, y + place // 6 * down, UNUSED_WIDTH, UNUSED_HEIGHT),
        )
        for place, cluster in enumerate(clusters)
    ]
