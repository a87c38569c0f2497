# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A sample of the points of tiles that another process reads, a tile at a time."""

from __future__ import annotations

from concurrent.futures import Future
from dataclasses import replace

import numpy as np

from rmw_manycore_py.ndt.geometry.arrays import Points
from rmw_manycore_py.ndt.geometry.thinning import spread_indices
from rmw_manycore_py.ndt.maps import map_process
from rmw_manycore_py.ndt.maps.map_tiles import TileFiles
from rmw_manycore_py.process.helper_process import HelperProcess


class MapSample:
    """Keeps the same share of the points of each tile.

    :ivar points: becomes the sample (N, 3), or the error of a tile.
    """

    def __init__(self, files: TileFiles, max_count: int) -> None:
        self.points: Future[Points] = Future()
        self._left = [replace(files, paths=(path,)) for path in files.paths]
        self._max_count = max_count
        self._kept: Points = np.zeros((0, 3), np.float32)
        self._seen = 0

    def read_tile(self, helper: HelperProcess) -> None:
        """Have a tile read; after the last one the sample is complete."""
        if self._left:
            tile = self._left.pop(0)
            points, self._seen = helper.call(
                map_process.sample_of, tile, self._seen, self._max_count
            )
            before = spread_indices(len(self._kept), self._max_count - len(points))
            self._kept = np.concatenate([self._kept[before], points])
        if not self._left:
            self.points.set_result(self._kept)
