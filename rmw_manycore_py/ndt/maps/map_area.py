# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Area of a map around a moving vehicle."""

from __future__ import annotations

import numpy as np

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.ndt.geometry.arrays import Points
from rmw_manycore_py.ndt.maps.map_tiles import TiledMap, TileFiles


class MapArea:
    """Tracks the loaded tiles, and when the vehicle needs others."""

    def __init__(self, tiles: TiledMap, radius_m: float, update_distance_m: float) -> None:
        self._tiles = tiles
        self._radius_m = radius_m
        self._update_distance_m = update_distance_m
        self._centre: tuple[float, float] | None = None
        self.files: TileFiles | None = None  # None: nothing usable is loaded

    def distance_m(self, x: float, y: float) -> float:
        """Return the distance to where the map was last loaded; infinity before the first load."""
        if self._centre is None:
            return float("inf")
        return float(np.hypot(x - self._centre[0], y - self._centre[1]))

    def update(self, x: float, y: float) -> Points | None:
        """Return the points (N, 3) around a position; None if the loaded ones suffice."""
        files = self._update(x, y)
        if files is None:
            return None
        try:
            return self._tiles.read(files)
        except ManycoreError:
            self.forget_tiles()
            raise

    def update_files(self, x: float, y: float) -> TileFiles | None:
        """Return the files around a position, for another process; None if those loaded suffice."""
        self._tiles.let_go()
        return self._update(x, y)

    def _update(self, x: float, y: float) -> TileFiles | None:
        if self.distance_m(x, y) <= self._update_distance_m:
            return None
        files = self._tiles.files_around(x, y, self._radius_m)
        self._centre = (x, y)
        if files == self.files:
            return None
        self.files = files
        return files

    def forget_tiles(self) -> None:
        """Reload at the next update, even the same tiles: the loaded ones cannot be used."""
        self.files = None
