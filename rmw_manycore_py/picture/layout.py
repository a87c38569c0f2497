# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Layout of clusters, cores, nodes and topics, after Fig. 11 of ROS-lite2."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

from rmw_manycore_py.picture.arcs import Arc, Wiring
from rmw_manycore_py.picture.frame import PAD, Frame, bands_of
from rmw_manycore_py.picture.geometry import Rect
from rmw_manycore_py.picture.plan import (
    CELL_HEAD,
    GAP,
    MAX_NODES_OF_CELL,
    NODE_HEIGHT,
    CellPlan,
    ClusterPlan,
    plan_clusters,
)
from rmw_manycore_py.picture.wires import wires_of
from rmw_manycore_py.platform.monitor.graph import Graph, Member

UNUSED_WIDTH, UNUSED_HEIGHT = 150.0, 30.0
_MIN_WIDTH = 500.0
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
    """A core in use, or a process without a core."""

    plan: CellPlan
    nodes: tuple[NodeBox, ...]
    rect: Rect

    @property
    def id(self) -> str:
        """Element id."""
        return self.plan.id

    @cached_property
    def cpu_id(self) -> str:
        """Element id of its CPU usage."""
        return f"{self.id}-cpu"

    @property
    def hidden(self) -> int:
        """Number of nodes that do not fit."""
        return len(self.plan.names) - len(self.nodes)


@dataclass(frozen=True)
class ClusterBox:
    """A cluster with its contents."""

    id: int
    is_used: bool
    cells: tuple[Cell, ...]
    free: Mapping[int, Rect]  # cores without a node
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
    """The picture, without what changes between looks."""

    clusters: tuple[ClusterBox, ...]
    arcs: tuple[Arc, ...]
    size: tuple[float, float]  # width and height

    @cached_property
    def cells(self) -> tuple[Cell, ...]:
        """All cells."""
        return tuple(cell for cluster in self.clusters for cell in cluster.cells)

    @cached_property
    def nodes(self) -> tuple[NodeBox, ...]:
        """All drawn nodes."""
        return tuple(node for cell in self.cells for node in cell.nodes)


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
    plans = plan_clusters(graph, present, dead, workers)
    wiring = Wiring(plans, bands_of(plans), wires_of(graph, plans))
    frame = wiring.frame
    boxes = [_cluster(plan, index, frame) for index, plan in enumerate(plans)]
    used = {plan.id for plan in plans}
    idle = [cluster for cluster in range(1, graph.cluster_count + 1) if cluster not in used]
    width = max(frame.width, _MIN_WIDTH)
    left = boxes[0].rect.x if boxes else PAD
    boxes += _idle_clusters(idle, left, frame.height, width)
    height = max(box.rect.bottom for box in boxes) + PAD
    return Layout(tuple(boxes), wiring.arcs(), (width, height))


def _cluster(plan: ClusterPlan, index: int, frame: Frame) -> ClusterBox:
    cells = tuple(_cell(cell, frame.cells[cell.id]) for row in plan.rows for cell in row)
    free = {core: frame.tiles[plan.id, core] for core in plan.free}
    return ClusterBox(plan.id, True, cells, free, frame.clusters[index])


def _cell(plan: CellPlan, rect: Rect) -> Cell:
    nodes = tuple(
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
    )
    return Cell(plan, nodes, rect)


def _idle_clusters(clusters: Sequence[int], x: float, y: float, width: float) -> list[ClusterBox]:
    in_line = int((width - x - PAD + GAP) // (UNUSED_WIDTH + GAP))
    return [
        ClusterBox(
            cluster,
            False,
            (),
            {},
            Rect(
                x + place % in_line * (UNUSED_WIDTH + GAP),
                y + place // in_line * (UNUSED_HEIGHT + GAP),
                UNUSED_WIDTH,
                UNUSED_HEIGHT,
            ),
        )
        for place, cluster in enumerate(clusters)
    ]
