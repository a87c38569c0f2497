# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Better reference poses of a recording, and a measure of poses that needs no reference.

Each scan is aligned to a map of the scans of the other parity, at fine voxels, and the maps are
made anew from the poses found. Half of each scan's points are aligned; the other half shows whether
that was an improvement: the better the poses, the thinner the surfaces on which it lies.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rmw_manycore_py.ndt import MatcherOptions, SerialMatcher, VoxelMap
from rmw_manycore_py.ndt.geometry import poses
from rmw_manycore_py.ndt.geometry.arrays import Matrix, Points
from rmw_manycore_py.ndt.recordings.recording import Recording

ROUNDS = 4
OPTIONS = MatcherOptions(
    voxel_size_m=0.5,
    coarse_levels=(4.0, 2.0),
    polish_levels=(),
    search="radius",
    trans_epsilon=1e-4,
    max_iterations=60,
)
FARTHEST_M = 0.2  # of a correction; beyond it an alignment has failed
CELL_M, CELL_POINTS = 0.5, 50
SEED = 7


@dataclass(frozen=True)
class Halves:
    """Random halves of the points of each scan: one to align, one to judge."""

    aligned: Sequence[Points]
    judging: Sequence[Points]

    @classmethod
    def of(cls, recording: Recording) -> Halves:
        """Divide the scans of a recording."""
        generator = np.random.default_rng(SEED)
        aligned, judging = [], []
        for index in range(len(recording)):
            scan = recording.scan(index)
            is_aligned = generator.random(len(scan)) < 0.5
            aligned.append(scan[is_aligned])
            judging.append(scan[~is_aligned])
        return cls(aligned, judging)


def refined_poses(scans: Sequence[Points], reference: Matrix) -> Matrix:
    """Return poses T_map_sensor (S, 4, 4) that fit the scans better than the reference."""
    T: Matrix = reference.copy()
    for _ in range(ROUNDS):
        # One after the other: aligned to each other at once, they would swap their errors.
        for parity in (0, 1):
            _align_to(cloud(scans[parity::2], T[parity::2]), scans, T, 1 - parity)
    return T


def _align_to(map_points: Points, scans: Sequence[Points], T: Matrix, parity: int) -> None:
    """Align every second scan to a map, in place."""
    with SerialMatcher(OPTIONS) as matcher:
        matcher.set_map(VoxelMap.from_points(map_points, OPTIONS))
        for index in range(parity, len(scans), 2):
            found = matcher.align(scans[index], T[index], only_pose=True).T_map_sensor
            if poses.distance_m(found, T[index]) < FARTHEST_M:
                T[index] = found


def cloud(scans: Sequence[Points], T: Matrix) -> Points:
    """Return the points of all scans in the map frame."""
    moved = [
        poses.transform(pose, scan.astype(np.float64)) for scan, pose in zip(scans, T, strict=True)
    ]
    points: Points = np.concatenate(moved)
    return points


def thicknesses_cm(points: Points) -> Matrix:
    """Return the standard deviation across the surface in each cell of many points."""
    cells = np.floor(points / CELL_M).astype(np.int64)
    _, cell, counts = np.unique(cells, axis=0, return_inverse=True, return_counts=True)
    order = np.argsort(cell.ravel(), kind="stable")
    starts = np.concatenate(([0], np.cumsum(counts)[:-1]))
    means = np.add.reduceat(points[order], starts) / counts[:, None]
    off = points[order] - np.repeat(means, counts, axis=0)
    squares = np.add.reduceat(off[:, :, None] * off[:, None, :], starts) / counts[:, None, None]
    smallest = np.linalg.eigvalsh(squares[counts >= CELL_POINTS])[:, 0]
    thicknesses: Matrix = 100.0 * np.sqrt(np.maximum(smallest, 0.0))
    return thicknesses
