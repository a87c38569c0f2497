# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What is joined by a line: topics from cells to cells, folded where they join the same ones."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from rmw_manycore_py.picture.plan import ClusterPlan
from rmw_manycore_py.platform.monitor.graph import Graph

# With more pairs of cells, all ends are joined to the first one of the other side.
MAX_PAIRS = 6

Pair = tuple[str, str]  # ids of the publishing and of the subscribing cell
_End = tuple[str, str]  # cell and node


@dataclass(frozen=True)
class Wire:
    """Topics drawn as one line."""

    topics: tuple[str, ...]
    nodes: tuple[str, ...]  # names of their nodes
    pairs: tuple[Pair, ...]

    @property
    def id(self) -> str:
        """Element id."""
        return f"t{self.topics[0]}"


def wires_of(graph: Graph, clusters: Sequence[ClusterPlan]) -> tuple[Wire, ...]:
    """Return a wire for each set of pairs of cells that topics join."""
    cells = _cells_of_processes(clusters)
    topics: dict[tuple[Pair, ...], list[str]] = {}
    nodes: dict[tuple[Pair, ...], set[str]] = {}
    for topic in graph.drawn_topics:
        ends: dict[str, set[_End]] = {"publisher": set(), "subscription": set()}
        for endpoint in graph.endpoints_of_topics[topic]:
            if endpoint.process in cells:
                ends[endpoint.kind].add((cells[endpoint.process], endpoint.node))
        if pairs := _pairs(sorted(ends["publisher"]), sorted(ends["subscription"])):
            topics.setdefault(pairs, []).append(topic)
            names = {name for side in ends.values() for _, name in side}
            nodes.setdefault(pairs, set()).update(names)
    return tuple(Wire(tuple(topics[pairs]), tuple(sorted(nodes[pairs])), pairs) for pairs in topics)


def _pairs(publishers: Sequence[_End], subscriptions: Sequence[_End]) -> tuple[Pair, ...]:
    if len(publishers) * len(subscriptions) > MAX_PAIRS:
        ends = [(publishers[0], end) for end in subscriptions]
        ends += [(start, subscriptions[0]) for start in publishers]
    else:
        ends = [(start, end) for start in publishers for end in subscriptions]
    return tuple(sorted({(start[0], end[0]) for start, end in ends if start != end}))


def _cells_of_processes(clusters: Sequence[ClusterPlan]) -> Mapping[int, str]:
    """Return the cell of each living process, by slot."""
    return {
        member.slot: cell.id
        for cluster in clusters
        for row in cluster.rows
        for cell in row
        for member in cell.living
    }
