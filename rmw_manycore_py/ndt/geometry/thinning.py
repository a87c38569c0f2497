# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Downsampling of a cloud to one point per voxel, or to a number of points.

Uses numpy, since nodes downsample scans and must not need Open3D; map files are downsampled with
Open3D (map_file.py).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.ndt.geometry.arrays import Points

MAX_CELLS = 1 << 62
SEED = 1  # fixed, so that a repeated scan gives a bit-identical pose


def voxel_centroids(points: Points, voxel_m: tuple[float, float, float]) -> Points:
    """Return the centroid of the points in each occupied voxel, like PCL's VoxelGrid; same dtype.

    :param points: (N, 3 or more), finite; further columns are averaged, too.
    :raises ManycoreError: if the cloud spans more voxels than 62 bits can number.
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
    """Return a selection of at most `wanted` of `count` points, spread evenly over their order.

    Stratified sampling: one random point from each interval of the order. LiDARs output points ring
    by ring or column by column, so every nth point might belong to few rings. Unlike voxel
    centroids, this preserves the density of the cloud and thus the score.
    """
    if count <= wanted:
        return slice(None)
    edges = np.linspace(0, count, wanted + 1).astype(np.int64)
    places = np.random.default_rng(SEED).random(wanted)
    return edges[:-1] + (places * np.diff(edges)).astype(np.int64)
