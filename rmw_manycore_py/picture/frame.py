# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Places of clusters and cells, and of the channels between them, in which topics run.

A row channel lies above and below each row of cells, a gutter on each side of a cluster, a band
channel above and below each band of clusters.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from enum import IntEnum
from typing import NamedTuple

from rmw_manycore_py.picture.geometry import Rect
from rmw_manycore_py.picture.plan import ClusterPlan

PAD = 12.0
HEAD = 66.0  # height of a cluster's title, SMEM bar and receive thread
TILE_WIDTH, TILE_HEIGHT, TILE_GAP = 22.0, 14.0, 3.0  # of a free core
_CELL_GAP = 10.0
_CELL_WIDTH, _NARROW_CELL = 150.0, 104.0
_MANY_COLUMNS = 5
_MIN_WIDTH = 300.0  # of a cluster, whose title needs it
_ASPECT = 1.5  # wanted width to height
_USUAL = 40.0  # thickness of channels for which that is


class Kind(IntEnum):
    """Of a channel."""

    ROW = 0
    GUTTER = 1
    BAND = 2


class Channel(NamedTuple):
    """A channel: its place is a cluster and row, a band and gutter, or a band."""

    kind: Kind
    group: int
    number: int = 0

    @property
    def is_vertical(self) -> bool:
        """Whether topics run up and down in it."""
        return self.kind is Kind.GUTTER


class Span(NamedTuple):
    """Extent of a channel across its direction."""

    start: float
    size: float

    @property
    def middle(self) -> float:
        """Centre line."""
        return self.start + self.size / 2


_MIN_SIZE = {Kind.ROW: 10.0, Kind.GUTTER: 20.0, Kind.BAND: 12.0}
Sizes = Mapping[Channel, float]
Bands = tuple[tuple[int, ...], ...]  # indices of clusters


class Frame:
    """Places for given sizes of the channels, by index of cluster and by cell.

    :param usual: size of row and band channels that `sizes` lacks.
    """

    def __init__(
        self, clusters: Sequence[ClusterPlan], bands: Bands, sizes: Sizes, usual: float = 0.0
    ) -> None:
        self.bands = bands
        self.clusters: dict[int, Rect] = {}
        self.cells: dict[str, Rect] = {}
        self.tiles: dict[tuple[int, int], Rect] = {}  # of free cores, by cluster and core
        self.channels: dict[Channel, Span] = {}
        self._sizes, self._usual = sizes, usual
        self.width = y = 0.0
        for band, members in enumerate(bands):
            y = self._add(Channel(Kind.BAND, band), y)
            x = 0.0
            for place, index in enumerate(members):
                x = self._add(Channel(Kind.GUTTER, band, place), x)
                self._place(clusters[index], index, x, y)
                x = self.clusters[index].right
            self.width = max(self.width, self._add(Channel(Kind.GUTTER, band, len(members)), x))
            y = max(self.clusters[index].bottom for index in members)
        self.height = self._add(Channel(Kind.BAND, len(bands)), y)

    def _add(self, channel: Channel, start: float) -> float:
        """Place a channel; return where it ends."""
        usual = 0.0 if channel.is_vertical else self._usual
        size = max(self._sizes.get(channel, usual), _MIN_SIZE[channel.kind])
        self.channels[channel] = Span(start, size)
        return start + size

    def _place(self, cluster: ClusterPlan, index: int, left: float, top: float) -> None:
        columns = cluster.columns
        cell = _CELL_WIDTH if columns < _MANY_COLUMNS else _NARROW_CELL
        inner = max(columns * (cell + _CELL_GAP) - _CELL_GAP, _MIN_WIDTH - 2 * PAD)
        y = self._add(Channel(Kind.ROW, index, 0), top + HEAD)
        for number, row in enumerate(cluster.rows):
            pitch = (inner + _CELL_GAP) / columns
            height = max(plan.height for plan in row)
            for column, plan in enumerate(row):
                x = left + PAD + column * pitch
                self.cells[plan.id] = Rect(x, y, pitch - _CELL_GAP, height)
            y = self._add(Channel(Kind.ROW, index, number + 1), y + height)
        in_line = int((inner + TILE_GAP) // (TILE_WIDTH + TILE_GAP))
        for place, core in enumerate(cluster.free):
            x = left + PAD + place % in_line * (TILE_WIDTH + TILE_GAP)
            line = y + place // in_line * (TILE_HEIGHT + TILE_GAP)
            self.tiles[cluster.id, core] = Rect(x, line, TILE_WIDTH, TILE_HEIGHT)
        lines = math.ceil(len(cluster.free) / in_line)
        bottom = y + lines * (TILE_HEIGHT + TILE_GAP) + PAD
        self.clusters[index] = Rect(left, top, inner + 2 * PAD, bottom - top)


def bands_of(clusters: Sequence[ClusterPlan]) -> Bands:
    """Return the division of the clusters into bands that suits a screen best."""
    every = range(len(clusters))
    divisions = [
        tuple(tuple(every[first : first + count]) for first in every[::count])
        for count in range(1, len(clusters) + 1)
    ]
    return min(divisions, key=lambda bands: _misfit(clusters, bands), default=())


def _misfit(clusters: Sequence[ClusterPlan], bands: Bands) -> float:
    frame = Frame(clusters, bands, {}, _USUAL)
    return abs(math.log(frame.width / frame.height / _ASPECT))
