# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Lines: topics from cells to cells.

Topics that join the same cells are one line, and so are those of parallel pipelines: names and
nodes that differ in a number only, between the same clusters.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

from rmw_manycore_py.picture.plan import ClusterPlan
from rmw_manycore_py.platform.monitor.graph import Graph

# With more pairs of cells, all ends are joined to the first one of the other side.
MAX_PAIRS = 6
# Fewer parallel pipelines stay apart.
MIN_PARALLEL = 3
_NUMBER = re.compile(r"\d+")

Pair = tuple[str, str]  # ids of the publishing and of the subscribing cell
_End = tuple[str, str]  # cell and node


@dataclass(frozen=True)
class Wire:
    """Topics drawn as one line."""

    nodes_of: Mapping[str, tuple[str, ...]]  # names of a topic's nodes, by topic
    pairs: tuple[Pair, ...]
    parallel: int = 1  # pipelines

    @cached_property
    def topics(self) -> tuple[str, ...]:
        """Names of its topics."""
        return tuple(self.nodes_of)

    @property
    def id(self) -> str:
        """Element id."""
        return f"t{self.topics[0]}"

    @cached_property
    def name(self) -> str:
        """Name of the first topic, and how many are drawn with it."""
        more = len(self.topics) // self.parallel - 1
        name = self.topics[0] if self.parallel == 1 else _common_name(self.topics)
        count = "" if self.parallel == 1 else f"{self.parallel} x "
        return f"{count}{name} +{more}" if more else f"{count}{name}"


def wires_of(graph: Graph, clusters: Sequence[ClusterPlan]) -> tuple[Wire, ...]:
    """Return a wire for each set of pairs of cells that topics join, parallel ones together."""
    cells = _cells_of_processes(clusters)
    topics: dict[tuple[Pair, ...], dict[str, tuple[str, ...]]] = defaultdict(dict)
    for topic in graph.drawn_topics:
        ends: dict[str, set[_End]] = {"publisher": set(), "subscription": set()}
        for endpoint in graph.endpoints_of_topics[topic]:
            if endpoint.process in cells:
                ends[endpoint.kind].add((cells[endpoint.process], endpoint.node))
        if pairs := _pairs(sorted(ends["publisher"]), sorted(ends["subscription"])):
            names = {name for side in ends.values() for _, name in side}
            topics[pairs][topic] = tuple(sorted(names))
    places = {c.id: cluster.id for cluster in clusters for row in cluster.rows for c in row}
    return _folded([Wire(nodes_of, pairs) for pairs, nodes_of in topics.items()], places)


def _folded(wires: Iterable[Wire], places: Mapping[str, int]) -> tuple[Wire, ...]:
    """Return the wires, those of parallel pipelines as one.

    :param places: cluster of each cell.
    """
    alike: dict[object, list[Wire]] = defaultdict(list)
    for wire in wires:
        names = [
            _NUMBER.sub("*", name) for item in wire.nodes_of.items() for name in (item[0], *item[1])
        ]
        clusters = frozenset((places[start], places[end]) for start, end in wire.pairs)
        alike[tuple(names), clusters].append(wire)
    return tuple(
        one for own in alike.values() for one in ([_together(own)] if _are_parallel(own) else own)
    )


def _are_parallel(wires: Sequence[Wire]) -> bool:
    """Return whether there are enough of them, and none goes on where another ends."""
    starts = {start for wire in wires for start, _ in wire.pairs}
    ends = {end for wire in wires for _, end in wire.pairs}
    return len(wires) >= MIN_PARALLEL and not starts & ends


def _together(wires: Sequence[Wire]) -> Wire:
    nodes_of = {topic: nodes for wire in wires for topic, nodes in wire.nodes_of.items()}
    pairs = {pair for wire in wires for pair in wire.pairs}
    return Wire(nodes_of, tuple(sorted(pairs)), len(wires))


def _common_name(topics: Sequence[str]) -> str:
    """Return the name of the first topic, with * for the numbers in which others like it differ."""
    pattern = _NUMBER.sub("*", topics[0])
    rows = [_NUMBER.findall(topic) for topic in topics if _NUMBER.sub("*", topic) == pattern]
    columns = iter("*" if len(set(column)) > 1 else column[0] for column in zip(*rows, strict=True))
    return _NUMBER.sub(lambda _: next(columns), topics[0])


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
