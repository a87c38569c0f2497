# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Shortest ways from cell to cell through the channels between them."""

from __future__ import annotations

import heapq
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from itertools import count, groupby, permutations
from typing import NamedTuple

from rmw_manycore_py.picture.frame import Channel, Frame, Kind
from rmw_manycore_py.picture.plan import ClusterPlan
from rmw_manycore_py.picture.wires import Pair

_CORNER = 30.0  # a way of one corner less may be so much longer
_Crossing = tuple[Channel, Channel]  # a horizontal and a vertical one
_Reached = tuple[float, _Crossing | None]  # distance, and the crossing before


class Route(NamedTuple):
    """A way: from the side of a cell through channels, horizontal and vertical in turn."""

    pair: Pair
    channels: tuple[Channel, ...]


class Router:
    """Finds ways; those from one cell are computed together."""

    def __init__(self, clusters: Sequence[ClusterPlan], frame: Frame) -> None:
        self._frame = frame
        self._beside: dict[str, tuple[Channel, Channel]] = {  # channels above and below a cell
            cell.id: (Channel(Kind.ROW, index, row), Channel(Kind.ROW, index, row + 1))
            for index, cluster in enumerate(clusters)
            for row, cells in enumerate(cluster.rows)
            for cell in cells
        }
        self._crossings: dict[Channel, list[_Crossing]] = defaultdict(list)
        for crossing in _crossings(clusters, frame):
            for channel in crossing:
                self._crossings[channel].append(crossing)
        self._neighbours: dict[_Crossing, list[tuple[_Crossing, float]]] = defaultdict(list)
        for crossings in self._crossings.values():
            for one, other in permutations(crossings, 2):
                self._neighbours[one].append((other, self._length(one, other)))
        self._ways_from = cache(self._find_ways)

    def route(self, pair: Pair) -> Route:
        """Return the shortest way between two cells."""
        start, end = pair
        shared = [one for one in self._beside[start] if one in self._beside[end]]
        if shared:
            return Route(pair, (shared[-1],))
        reached = self._ways_from(start)
        x = self._frame.cells[end].centre[0]
        _, at, last = min(
            (reached[crossing][0] + abs(self._x(crossing) - x), crossing, channel)
            for channel in self._beside[end]
            for crossing in self._crossings[channel]
        )
        backwards = [last]
        while (before := reached[at][1]) is not None:
            backwards.append(at[0] if at[0] == before[0] else at[1])
            at = before
        backwards.append(at[0])
        return Route(pair, tuple(channel for channel, _ in groupby(reversed(backwards))))

    def _find_ways(self, start: str) -> Mapping[_Crossing, _Reached]:
        """Return the distance of each crossing from a cell (Dijkstra)."""
        x = self._frame.cells[start].centre[0]
        reached: dict[_Crossing, _Reached] = {}
        numbers = count()  # of equal distances the first one
        queue: list[tuple[float, int, _Crossing, _Crossing | None]] = [
            (abs(self._x(crossing) - x), next(numbers), crossing, None)
            for channel in self._beside[start]
            for crossing in self._crossings[channel]
        ]
        heapq.heapify(queue)
        while queue:
            distance, _, crossing, before = heapq.heappop(queue)
            if crossing in reached:
                continue
            reached[crossing] = (distance, before)
            for neighbour, length in self._neighbours[crossing]:
                if neighbour not in reached:
                    heapq.heappush(queue, (distance + length, next(numbers), neighbour, crossing))
        return reached

    def _length(self, one: _Crossing, other: _Crossing) -> float:
        (x0, y0), (x1, y1) = ((self._x(c), self._frame.channels[c[0]].middle) for c in (one, other))
        return abs(x1 - x0) + abs(y1 - y0) + _CORNER

    def _x(self, crossing: _Crossing) -> float:
        return self._frame.channels[crossing[1]].middle


def _crossings(clusters: Sequence[ClusterPlan], frame: Frame) -> Iterator[_Crossing]:
    for band, members in enumerate(frame.bands):
        for gutter in range(len(members) + 1):
            vertical = Channel(Kind.GUTTER, band, gutter)
            yield Channel(Kind.BAND, band), vertical
            yield Channel(Kind.BAND, band + 1), vertical
            for index in members[max(gutter - 1, 0) : gutter + 1]:
                for row in range(len(clusters[index].rows) + 1):
                    yield Channel(Kind.ROW, index, row), vertical
