# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Topics as curves from publishing to subscribing nodes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

from rmw_manycore_py.picture.geometry import Curve, Point, Rect, connect, mean
from rmw_manycore_py.picture.layout import Layout
from rmw_manycore_py.platform.monitor.graph import Graph

# With more pairs, curves meet in a point instead of n * m curves.
MAX_PAIRS = 6
_HUB_SIDE = 6.0


@dataclass(frozen=True)
class Arc:
    """A topic as drawn."""

    id: str
    topic: str
    curves: tuple[Curve, ...]
    label_at: Point

    @cached_property
    def label_id(self) -> str:
        """Element id of its label."""
        return f"{self.id}-label"


def arcs_of(graph: Graph, layout: Layout) -> tuple[Arc, ...]:
    """Return an arc for each topic that connects drawn nodes."""
    places = _places(layout)
    found = []
    for topic in graph.drawn_topics:
        ends: dict[str, list[Rect]] = {"publisher": [], "subscription": []}
        for kind, key in {(e.kind, (e.process, e.node)) for e in graph.endpoints_of_topics[topic]}:
            if key in places:
                ends[kind].append(places[key])
        curves = _curves(ends["publisher"], ends["subscription"])
        if curves:
            label_at = mean(curve.middle for curve in curves)
            found.append(Arc(f"t{topic}", topic, curves, label_at))
    return tuple(found)


def _places(layout: Layout) -> Mapping[tuple[int, str], Rect]:
    """Return the position of each living node; a hidden one is at its cell."""
    places: dict[tuple[int, str], Rect] = {}
    for cell in layout.cells:
        for member in cell.members:
            places.update({(member.slot, name): cell.rect for name in member.nodes})
        places.update(
            {(box.member.slot, box.name): box.rect for box in cell.nodes if not box.is_dead}
        )
    return places


def _curves(publishers: Sequence[Rect], subscriptions: Sequence[Rect]) -> tuple[Curve, ...]:
    pairs = [(start, end) for start in publishers for end in subscriptions if start != end]
    if len(pairs) <= MAX_PAIRS:
        return tuple(connect(start, end) for start, end in sorted(pairs, key=_order))
    x, y = mean(rect.centre for rect in (*publishers, *subscriptions))
    hub = Rect(x - _HUB_SIDE / 2, y - _HUB_SIDE / 2, _HUB_SIDE, _HUB_SIDE)
    to_hub = tuple(connect(start, hub) for start in sorted(publishers, key=_corner))
    return to_hub + tuple(connect(hub, end) for end in sorted(subscriptions, key=_corner))


def _corner(rect: Rect) -> Point:
    return rect.y, rect.x


def _order(pair: tuple[Rect, Rect]) -> tuple[Point, Point]:
    return _corner(pair[0]), _corner(pair[1])
