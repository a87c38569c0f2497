# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The score that unseen points of a mapped place reach: a map's own score.

Voxels fit the few points they are made of better than any scan does, and points of voxels that
have too few see none. So some points are held out of a second map of the others, and scored in it.
"""

from __future__ import annotations

from contextlib import suppress

import numpy as np

from rmw_manycore_py.native import _ndt
from rmw_manycore_py.ndt.geometry.arrays import Matrix
from rmw_manycore_py.ndt.geometry.thinning import spread_indices
from rmw_manycore_py.ndt.matching.kernel_options import map_options, match_options
from rmw_manycore_py.ndt.matching.options import MatcherOptions

# Which points are held out: a prime, as those of a LiDAR come ring by ring, of 16 to 128.
HELD_EVERY, HELD_EVERY_OF_FEW, FEW = 53, 11, 50_000
SAMPLE = 20_000  # number of held out points that are scored


def own_score_of(xyz_m: Matrix, finest: _ndt.VoxelMap, options: MatcherOptions) -> float:
    """Return the fit (see :class:`Alignment`) of points (N, 3) [m] held out of their map.

    :param finest: the map of all points, scored instead where the others make no voxel.
    """
    every = HELD_EVERY_OF_FEW if len(xyz_m) < FEW else HELD_EVERY
    held, voxel_map = xyz_m[::every], finest
    with suppress(_ndt.NdtError):
        voxel_map = _ndt.VoxelMap(xyz_m, map_options(options), without_every=every)
    held = held[np.isfinite(held).all(axis=1)]
    held = held[spread_indices(len(held), SAMPLE)]
    middle = np.eye(4)
    if len(held):
        middle[:3, 3] = np.median(held, axis=0)
    relative = np.ascontiguousarray(held - middle[:3, 3], np.float32)
    matcher = _ndt.SerialMatcher(match_options(options))
    found = matcher.evaluate([voxel_map], relative, middle)
    return found.nearest / found.scan_points if found.scan_points else 0.0
