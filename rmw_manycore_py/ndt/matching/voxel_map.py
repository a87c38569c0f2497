# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A map as normal distributions."""

from __future__ import annotations

from numpy.typing import ArrayLike

from rmw_manycore_py import _ndt
from rmw_manycore_py.errors import EXIT_BAD_INPUT
from rmw_manycore_py.native_errors import translate_native_errors
from rmw_manycore_py.ndt.geometry.arrays import map_points
from rmw_manycore_py.ndt.matching.kernel_options import map_options
from rmw_manycore_py.ndt.matching.options import MatcherOptions


class VoxelMap:
    """The normal distributions of a map; immutable, in memory that workers share.

    A map answers the questions of one search with one voxel size and kind of covariance: those of
    the options it was built with.
    """

    def __init__(self, native: _ndt.VoxelMap, options: MatcherOptions) -> None:
        self.native = native
        self.options = options

    @classmethod
    def from_points(cls, points: ArrayLike, options: MatcherOptions | None = None) -> VoxelMap:
        """Build a map from points (N, 3) [m, map frame]; those that are not finite are left out.

        :raises ManycoreError: when no voxel has enough points, or the points span too many voxels.
        """
        options = options or MatcherOptions()
        with translate_native_errors(exit_status=EXIT_BAD_INPUT):
            native = _ndt.VoxelMap(map_points(points), map_options(options))
        return cls(native, options)

    @property
    def voxels(self) -> int:
        """Return the number of voxels with a normal distribution."""
        return self.native.voxels

    @property
    def size_bytes(self) -> int:
        """Return the memory the map takes."""
        return self.native.size_bytes
