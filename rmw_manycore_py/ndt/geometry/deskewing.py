# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Deskewing: removes the sensor's motion during a scan."""

from __future__ import annotations

import numpy as np

from rmw_manycore_py.ndt.geometry.arrays import Matrix, Points
from rmw_manycore_py.ndt.geometry.poses import cross_matrix, rotation_vector


def deskewed(points: Points, shares: Matrix, motion: Matrix) -> Points:
    """Return points (N, 3) as seen from the sensor's pose at share 0 of the motion.

    Assumes constant speed and turn rate: the sensor pose at share s is interpolated linearly in
    translation and rotation vector of `motion`.

    :param shares: (N) share of the motion at each point; extrapolated below 0 and above 1.
    :param motion: T_before_after (4, 4).
    """
    turn = rotation_vector(motion[:3, :3])
    angle = float(np.linalg.norm(turn))
    moved: Points = np.asarray(points, np.float64)
    if angle > 1e-12:
        # Rodrigues' formula, with one angle per point.
        axis = turn / angle
        angles = (angle * shares)[:, None]
        across = moved @ cross_matrix(axis).T
        again = across @ cross_matrix(axis).T
        moved = moved + np.sin(angles) * across + (1.0 - np.cos(angles)) * again
    moved = moved + shares[:, None] * motion[:3, 3]
    return moved.astype(points.dtype, copy=False)
