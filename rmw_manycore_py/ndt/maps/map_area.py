# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The part of a map that is around a moving vehicle."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from rmw_manycore_py.ndt.geometry.arrays import Points
from rmw_manycore_py.ndt.maps.map_tiles import TiledMap


class MapArea:
    """Knows what is loaded, and when the vehicle has moved so far that other tiles are needed."""

    def __init__(self, tiles: TiledMap, radius_m: float, update_distance_m: float) -> None:
        self._tiles = tiles
        self._radius_m = radius_m
        self._update_distance_m = update_distance_m
        self._centre: tuple[float, float] | None = None
        self._names: frozenset[Path] | None = None  # None: none are loaded, or they are of no use

    def distance_m(self, x: float, y: float) -> float:
        """Return how far a place is from where the map was loaded last; infinity before that."""
        if self._centre is None:
            return float("inf")
        return float(np.hypot(x - self._centre[0], y - self._centre[1]))

    def update(self, x: float, y: float) -> Points | None:
        """Return the points (N, 3) around a place, or None where those loaded will do."""
        if self.distance_m(x, y) <= self._update_distance_m:
            return None
        names = self._tiles.names_around(x, y, self._radius_m)
        self._centre = (x, y)
        if names == self._names:
            return None
        self._names, points = self._tiles.around(x, y, self._radius_m)
        return points

    def forget_tiles(self) -> None:
        """Load tiles anew at the next update, even the same: what was loaded cannot be used."""
        self._names = None
