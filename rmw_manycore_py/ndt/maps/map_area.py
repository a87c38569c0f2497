# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Area of a map around a moving vehicle."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.ndt.geometry.arrays import Points
from rmw_manycore_py.ndt.maps.map_tiles import TiledMap, TileFiles
from rmw_manycore_py.process.steady import steady_s

RETRY_S = 3.0  # reading all tiles may take a second


@dataclass(frozen=True)
class Area:
    """Tiles around a place (x, y) [m]."""

    files: TileFiles
    centre: tuple[float, float]


class MapArea:
    """Tracks the tiles in use, and when the vehicle needs others.

    What an update returns is in use from `accept` on. After `refuse`, or if it cannot be read, it
    is returned again: where the vehicle has moved far enough, or some seconds later.

    :ivar asked: area of the last update; `loaded` is the one in use.
    """

    def __init__(self, tiles: TiledMap, radius_m: float, update_distance_m: float) -> None:
        self._tiles = tiles
        self._radius_m = radius_m
        self._update_distance_m = update_distance_m
        self._retry_s = np.inf
        self.asked: Area | None = None
        self.loaded: Area | None = None

    def is_due(self, x: float, y: float) -> bool:
        """Return whether a vehicle at a position may need other tiles."""
        is_far = _distance_m(self.asked, x, y) > self._update_distance_m
        return is_far or steady_s() > self._retry_s

    def distance_m(self, x: float, y: float) -> float:
        """Return the distance to the centre of the tiles in use; infinity before the first."""
        return _distance_m(self.loaded, x, y)

    def update(self, x: float, y: float) -> Points | None:
        """Return the points (N, 3) around a position; None if those in use suffice."""
        files = self._update(x, y)
        if files is None:
            return None
        try:
            return self._tiles.read(files)
        except ManycoreError:
            self.refuse()
            raise

    def update_files(self, x: float, y: float) -> TileFiles | None:
        """Return the files around a position, for another process; None if those in use suffice."""
        self._tiles.let_go()
        return self._update(x, y)

    def _update(self, x: float, y: float) -> TileFiles | None:
        if not self.is_due(x, y):
            return None
        self._retry_s = np.inf
        self.asked = Area(self._tiles.files_around(x, y, self._radius_m), (x, y))
        if self.loaded is not None and self.loaded.files == self.asked.files:
            self.loaded = self.asked
            return None
        return self.asked.files

    def accept(self, area: Area | None) -> None:
        """Use an area that was asked for."""
        self.loaded = area

    def refuse(self) -> None:
        """Go on with the area in use: the one that was asked for cannot be used now."""
        self._retry_s = steady_s() + RETRY_S


def _distance_m(area: Area | None, x: float, y: float) -> float:
    if area is None:
        return float("inf")
    return float(np.hypot(x - area.centre[0], y - area.centre[1]))
