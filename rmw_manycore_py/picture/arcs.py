# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Topics, as curves from the nodes that publish to those that subscribe."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from rmw_manycore_py.look.graph import Graph
from rmw_manycore_py.picture.geometry import Curve, Point, Rect, connect, mean
from rmw_manycore_py.picture.layout import Layout

# More pairs than this meet in a point: n * m curves would hide each other.
MAX_PAIRS = 6
_HUB_SIDE = 6.0


@dataclass(frozen=True)
class Arc:
    """A topic as it is drawn."""

    id: str
    topic: str
    curves: tuple[Curve, ...]
    label_at: Point


def arcs_of(graph: Graph, layout: Layout) -> tuple[Arc, ...]:
    """Return an arc for each topic that connects nodes that are drawn."""
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
    """Return where each living node is; one that has no room is where its cell is."""
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
