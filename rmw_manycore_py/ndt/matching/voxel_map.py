# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A map of normal distributions."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import suppress
from functools import cached_property

from numpy.typing import ArrayLike

from rmw_manycore_py.errors import EXIT_BAD_INPUT
from rmw_manycore_py.native import _ndt
from rmw_manycore_py.native.errors import translate_native_errors
from rmw_manycore_py.ndt.geometry.arrays import Matrix, map_points
from rmw_manycore_py.ndt.matching.kernel_options import (
    coarse_options,
    map_options,
    polish_options,
)
from rmw_manycore_py.ndt.matching.options import MatcherOptions
from rmw_manycore_py.ndt.matching.own_score import own_score_of

MAX_SEARCH_MAP_BYTES = 64 << 20  # of a map of about 1 km by 1 km


class VoxelMap:
    """Normal distributions of a map; immutable, in memory shared with workers.

    A map can only be used with the search, voxel sizes and covariance of the options it was built
    with.

    :param levels: coarsest first: those of a second look, the coarse ones, the one of all scores,
        and those that refine poses.
    :param own_score: mean score of the map's own points (own_score.py): about that of a scan at a
        right pose in which nothing is hidden.
    """

    def __init__(
        self, levels: list[_ndt.VoxelMap], options: MatcherOptions, own_score: float
    ) -> None:
        self.levels = levels
        self.first = len(options.second_look_levels)
        self.scored = len(options.coarser_levels)
        self.options = options
        self.own_score = own_score

    @classmethod
    def from_points(cls, points: ArrayLike, options: MatcherOptions | None = None) -> VoxelMap:
        """Build a map from points (N, 3) [m, map frame]; non-finite ones are dropped.

        :raises ManycoreError: if no voxel has enough points, or the points span too many voxels.
        """
        options = options or MatcherOptions()
        with translate_native_errors(exit_status=EXIT_BAD_INPUT):
            xyz_m = map_points(points)
            finest = _ndt.VoxelMap(xyz_m, map_options(options))
            coarse = [
                _ndt.VoxelMap(xyz_m, coarse_options(options, factor))
                for factor in options.coarser_levels
            ]
            polishing = list(_polishing(xyz_m, options))
            own_score = own_score_of(xyz_m, finest, options)
        return cls([*coarse, finest, *polishing], options, own_score)

    @classmethod
    def attach(
        cls, shared_paths: Sequence[str], options: MatcherOptions, own_score: float
    ) -> VoxelMap:
        """Attach to a map held by another process; it stays valid after that process's end.

        :param shared_paths: paths of its levels, coarsest first.
        :raises ManycoreError: if the map no longer exists.
        """
        with translate_native_errors("the map of another process"):
            levels = [_ndt.VoxelMap.attach(path) for path in shared_paths]
        return cls(levels, options, own_score)

    @property
    def shared_paths(self) -> list[str]:
        """Return the paths at which this user's processes can attach while this process lives."""
        return [level.shared_path for level in self.levels]

    @property
    def finest(self) -> _ndt.VoxelMap:
        """Return the level used for scores."""
        return self.levels[self.scored]

    @cached_property
    def search_map(self) -> _ndt.SearchMap | None:
        """Return where something is in this map; None if it is too large for that.

        Built at the first use, for searches around a guess.
        """
        with suppress(_ndt.NdtError):  # far too large
            if _ndt.SearchMap.bytes_for(self.finest) <= MAX_SEARCH_MAP_BYTES:
                return _ndt.SearchMap(self.finest)
        return None

    @property
    def polishing(self) -> int:
        """Return the number of levels that only refine poses."""
        return len(self.levels) - self.scored - 1

    @property
    def voxels(self) -> int:
        """Return the number of voxels of the level used for scores."""
        return self.finest.voxels

    @property
    def size_bytes(self) -> int:
        """Return the memory of all levels in bytes."""
        return sum(level.size_bytes for level in self.levels)


def _polishing(xyz_m: Matrix, options: MatcherOptions) -> Iterator[_ndt.VoxelMap]:
    """Yield the levels that refine poses, as far as the points allow: none is essential."""
    with suppress(_ndt.NdtError):  # too few points for such voxels, or too many voxels
        for factor in options.polishing_levels:
            yield _ndt.VoxelMap(xyz_m, polish_options(options, factor))
