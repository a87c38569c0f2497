# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Deskewing: removes the sensor's motion during a scan."""

from __future__ import annotations

import numpy as np

from rmw_manycore_py.ndt.geometry.arrays import Matrix, Points
from rmw_manycore_py.ndt.geometry.poses import cross_matrix, travelled, velocities


def deskewed(points: Points, shares: Matrix, motion: Matrix) -> Points:
    """Return points (N, 3) as seen from the sensor's pose at share 0 of the motion.

    Assumes constant velocities in the sensor's frame: a turning vehicle drives an arc, and the
    chord of `motion` points half the turned angle off where it starts.

    :param shares: (N) share of the motion at each point; extrapolated below 0 and above 1.
    :param motion: T_before_after (4, 4).
    """
    v, w = velocities(motion)
    moved: Points = np.asarray(points, np.float64)
    angle = float(np.linalg.norm(w))
    if angle > 1e-12:
        # Rodrigues' formula, with one angle per point.
        K = cross_matrix(w / angle)
        angles = (angle * shares)[:, None]
        across = moved @ K.T
        again = across @ K.T
        moved = moved + np.sin(angles) * across + (1.0 - np.cos(angles)) * again
    moved = moved + travelled(v, w, shares)
    return moved.astype(points.dtype, copy=False)
