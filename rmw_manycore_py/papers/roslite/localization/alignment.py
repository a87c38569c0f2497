# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Alignment of a scan by sums that are computed here or elsewhere, and the next guess."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rmw_manycore_py.native import _ndt
from rmw_manycore_py.native.errors import translate_native_errors
from rmw_manycore_py.ndt.geometry.arrays import Matrix
from rmw_manycore_py.ndt.matching.kernel_options import match_options
from rmw_manycore_py.ndt.matching.options import MatcherOptions
from rmw_manycore_py.papers.roslite.localization.tiles import Pairs, TileKey, joined, points_by_tile

SumsAt = Callable[[Matrix], NDArray[np.float64]]


def aligned(guess: Matrix, sums_at: SumsAt, options: MatcherOptions) -> _ndt.NewtonResult:
    """Return where Newton's method ends; `sums_at` computes a pass at a pose (4, 4)."""
    return _ndt.maximise_sums(match_options(options), options.voxel_size_m, guess, sums_at)


def sums_of(found: Pairs, options: MatcherOptions) -> NDArray[np.float64]:
    """Return the sums (37,) over pairs: what `derivatives` computes."""
    with translate_native_errors("pairs"):
        return _ndt.sums_of_pairs(*found, options.outlier_ratio, options.voxel_size_m)


def pairs_in(
    tiles: Mapping[TileKey, _ndt.VoxelMap],
    points_m: NDArray[np.float32],
    pose: Matrix,
    tile_m: float,
) -> Pairs:
    """Return the pairs of points (N, 3) at a pose, for a map that is all at hand."""
    parts = points_by_tile(points_m, pose, tile_m)
    return joined(
        _ndt.search_pairs(tiles[key], part, pose) for key, part in parts.items() if key in tiles
    )


@dataclass
class Prediction:
    """Guesses from the motion between the last two poses, as ndt_matching makes them."""

    pose: Matrix
    stamp_s: float
    _motion: Matrix | None = None
    _motion_s: float = 0.0

    def guess(self, stamp_s: float) -> Matrix:
        """Return the pose if the last motion goes on; over its time, or none."""
        if self._motion is None or not 0.0 < stamp_s - self.stamp_s < 2.0 * self._motion_s:
            return self.pose
        return np.ascontiguousarray(self.pose @ self._motion)

    def update(self, pose: Matrix, stamp_s: float) -> None:
        """Take the pose of a scan."""
        self._motion = np.linalg.inv(self.pose) @ pose
        self._motion_s = stamp_s - self.stamp_s
        self.pose, self.stamp_s = pose, stamp_s
