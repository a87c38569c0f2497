# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A map as normal distributions."""

from __future__ import annotations

from numpy.typing import ArrayLike

from rmw_manycore_py import _ndt
from rmw_manycore_py.errors import EXIT_BAD_INPUT
from rmw_manycore_py.native_errors import translate_native_errors
from rmw_manycore_py.ndt.geometry.arrays import map_points
from rmw_manycore_py.ndt.matching.kernel_options import coarse_options, map_options
from rmw_manycore_py.ndt.matching.options import MatcherOptions


class VoxelMap:
    """The normal distributions of a map; immutable, in memory that workers share.

    A map answers the questions of one search with one series of voxel sizes and one kind of
    covariance: those of the options it was built with.

    :param levels: coarsest first.
    """

    def __init__(self, levels: list[_ndt.VoxelMap], options: MatcherOptions) -> None:
        self.levels = levels
        self.options = options

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
        return cls([*coarse, finest], options)

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
