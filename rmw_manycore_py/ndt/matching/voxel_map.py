# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A map as normal distributions."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from rmw_manycore_py import _ndt
from rmw_manycore_py.errors import EXIT_BAD_INPUT
from rmw_manycore_py.native_errors import translate_native_errors
from rmw_manycore_py.ndt.geometry.arrays import Matrix, map_points
from rmw_manycore_py.ndt.matching.alignment import Score
from rmw_manycore_py.ndt.matching.kernel_options import (
    coarse_options,
    map_options,
    match_options,
)
from rmw_manycore_py.ndt.matching.options import MatcherOptions

SAMPLE = 20_000  # of a map's points, whose score is taken


class VoxelMap:
    """The normal distributions of a map; immutable, in memory that workers share.

    A map answers the questions of one search with one series of voxel sizes and one kind of
    covariance: those of the options it was built with.

    :param levels: coarsest first.
    :param own_likelihood: nearest-voxel likelihood of the map's own points, where they lie: what no
        scan is expected to exceed by much.
    """

    def __init__(
        self, levels: list[_ndt.VoxelMap], options: MatcherOptions, own_likelihood: float
    ) -> None:
        self.levels = levels
        self.options = options
        self.own_likelihood = own_likelihood

    @classmethod
    def from_points(cls, points: ArrayLike, options: MatcherOptions | None = None) -> VoxelMap:
        """Build a map from points (N, 3) [m, map frame]; those that are not finite are left out.

        :raises ManycoreError: when no voxel has enough points, or the points span too many voxels.
        """
        options = options or MatcherOptions()
        with translate_native_errors(exit_status=EXIT_BAD_INPUT):
            xyz_m = map_points(points)
            finest = _ndt.VoxelMap(xyz_m, map_options(options))
            coarse = [
                _ndt.VoxelMap(xyz_m, coarse_options(options, factor))
                for factor in options.coarse_levels
            ]
            own_likelihood = _likelihood(finest, xyz_m, options)
        return cls([*coarse, finest], options, own_likelihood)

    @classmethod
    def attach(
        cls, shared_paths: Sequence[str], options: MatcherOptions, own_likelihood: float
    ) -> VoxelMap:
        """Return a map that another process holds, and that outlives it from now on.

        :param shared_paths: of its levels, coarsest first.
        :raises ManycoreError: when there is none any more.
        """
        with translate_native_errors("the map of another process"):
            levels = [_ndt.VoxelMap.attach(path) for path in shared_paths]
        return cls(levels, options, own_likelihood)

    @property
    def shared_paths(self) -> list[str]:
        """Return where other processes of this user find the levels while this one lives."""
        return [level.shared_path for level in self.levels]

    @property
    def finest(self) -> _ndt.VoxelMap:
        """Return the level that scores and results are of."""
        return self.levels[-1]

    @property
    def voxels(self) -> int:
        """Return the number of voxels with a normal distribution, of the finest level."""
        return self.finest.voxels

    @property
    def size_bytes(self) -> int:
        """Return the memory that all levels take."""
        return sum(level.size_bytes for level in self.levels)


def _likelihood(finest: _ndt.VoxelMap, points: Matrix, options: MatcherOptions) -> float:
    sample = points[:: max(1, len(points) // SAMPLE)]
    sample = sample[np.isfinite(sample).all(axis=1)]
    middle = np.eye(4)
    if len(sample):
        middle[:3, 3] = np.median(sample, axis=0)
    relative = np.ascontiguousarray(sample - middle[:3, 3], np.float32)
    matcher = _ndt.SerialMatcher(match_options(options))
    return Score.of(matcher.evaluate([finest], relative, middle)).nearest_voxel_likelihood
