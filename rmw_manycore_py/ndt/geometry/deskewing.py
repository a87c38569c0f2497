# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Scans as one moment would have seen them: the motion while they were taken is taken out."""

from __future__ import annotations

import numpy as np

from rmw_manycore_py.ndt.geometry.arrays import Matrix, Points
from rmw_manycore_py.ndt.geometry.poses import rotation_vector


def deskewed(points: Points, shares: Matrix, motion: Matrix) -> Points:
    """Return points (N, 3) as seen from where the sensor was when its share of a motion was 0.

    With speed and turn rate constant: a point at the share s was seen from the pose at s of the
    line and the turn of `motion`.

    :param shares: (N), of the motion; below 0 and above 1 it is continued.
    :param motion: T_before_after (4, 4).
    """
    turn = rotation_vector(motion[:3, :3])
    angle = float(np.linalg.norm(turn))
    moved: Points = np.asarray(points, np.float64)
    if angle > 1e-12:
        # Rodrigues, for an angle of each point.
        axis = turn / angle
        angles = (angle * shares)[:, None]
        across = np.cross(axis, moved)
        moved = moved + np.sin(angles) * across + (1.0 - np.cos(angles)) * np.cross(axis, across)
    moved = moved + shares[:, None] * motion[:3, 3]
    return moved.astype(points.dtype, copy=False)
