# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The score that unseen points of a mapped place reach: a map's own score.

Voxels fit the few points they are made of better than any scan does, and points of voxels that
have too few see none. So some points are held out of a second map of the others, and scored in it.
Those in columns without a voxel do not count: scans near the vehicle have few of them.
"""

from __future__ import annotations

from contextlib import suppress

import numpy as np

from rmw_manycore_py.native import _ndt
from rmw_manycore_py.ndt.geometry.arrays import Matrix
from rmw_manycore_py.ndt.geometry.thinning import spread_indices
from rmw_manycore_py.ndt.matching.kernel_options import map_options, match_options
from rmw_manycore_py.ndt.matching.options import MatcherOptions

HELD_EVERY = 31  # odd, as a LiDAR may give the points of its 16 to 128 rings in turn
SAMPLE = 20_000  # number of points that are scored
# Of the score of what voxels are made of. Less is that of a map whose voxels are lost without the
# points that are held out.
LEAST_SHARE = 0.87


def own_score_of(xyz_m: Matrix, finest: _ndt.VoxelMap, options: MatcherOptions) -> float:
    """Return the mean score of points (N, 3) [m] that are held out of their map.

    :param finest: the map of all points.
    """
    of_all = _evaluated(xyz_m, finest, options)
    least = LEAST_SHARE * of_all.nearest / of_all.points if of_all.points else 0.0
    with suppress(_ndt.NdtError):  # the others make no voxel
        others = _ndt.VoxelMap(xyz_m, map_options(options), without_every=HELD_EVERY)
        held = _evaluated(xyz_m[::HELD_EVERY], others, options)
        return max(least, held.nearest / max(held.scan_points, 1))
    return least


def _evaluated(
    points: Matrix, voxel_map: _ndt.VoxelMap, options: MatcherOptions
) -> _ndt.Derivatives:
    """Score those of points (N, 3) [m] that are above or below a voxel."""
    sample = points[spread_indices(len(points), SAMPLE)]
    sample = sample[np.isfinite(sample).all(axis=1)]
    middle = np.eye(4)
    if len(sample):
        middle[:3, 3] = np.median(sample, axis=0)
    relative = np.ascontiguousarray(sample - middle[:3, 3], np.float32)
    known = relative[voxel_map.columns_around(relative, middle) > 0]
    matcher = _ndt.SerialMatcher(match_options(options))
    return matcher.evaluate([voxel_map], known if len(known) else relative, middle)
