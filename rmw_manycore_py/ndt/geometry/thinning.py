# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Thinning a cloud: to one point per voxel, or to a number of points.

In numpy, as scans are thinned by nodes, which must not need Open3D; map files are thinned with
that (map_file.py).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.ndt.geometry.arrays import Points

MAX_CELLS = 1 << 62
SEED = 1  # the same choice each time: a scan repeated gives the same pose, to the last bit


def voxel_centroids(points: Points, voxel_m: tuple[float, float, float]) -> Points:
    """Return the mean of the points in each occupied voxel, as PCL's VoxelGrid does; same type.

    `points` (N, 3 or more) must be finite; columns behind the third are means too. Where voxels
    are too small for the cloud's extent to be numbered with 62 bits, a ManycoreError says so.
    """
    if len(points) == 0:
        return points
    steps = np.floor(points[:, :3] / np.asarray(voxel_m, np.float64))
    steps -= steps.min(axis=0)
    if np.prod(steps.max(axis=0) + 1.0) > MAX_CELLS:
        raise ManycoreError(
            f"voxels of {voxel_m} m are too small for a cloud of this extent", EXIT_BAD_INPUT
        )
    cells = steps.astype(np.int64)
    sizes = cells.max(axis=0) + 1
    keys = (cells[:, 0] * sizes[1] + cells[:, 1]) * sizes[2] + cells[:, 2]
    order = np.argsort(keys, kind="stable")
    in_order = keys[order]
    starts = np.flatnonzero(np.concatenate(([True], in_order[1:] != in_order[:-1])))
    counts = np.diff(np.append(starts, len(keys)))
    sums = np.add.reduceat(points[order].astype(np.float64), starts, axis=0)
    return (sums / counts[:, None]).astype(points.dtype)


def spread_indices(count: int, wanted: int) -> slice | NDArray[np.int64]:
    """Return what chooses at most `wanted` of `count` points, evenly spread over their order.

    One of each stretch of the order, at a place in it that is drawn: LiDARs put out points ring by
    ring or column by column, so that every nth point may be of the same few rings. Unlike means of
    voxels they keep the cloud's density, and with it the score.
    """
    if count <= wanted:
        return slice(None)
    edges = np.linspace(0, count, wanted + 1).astype(np.int64)
    places = np.random.default_rng(SEED).random(wanted)
    return edges[:-1] + (places * np.diff(edges)).astype(np.int64)
