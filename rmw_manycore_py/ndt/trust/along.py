# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A direction in which a position is uncertain: along a tunnel, or a gap without scans.

Scans do not constrain it, or several places along it fit. It ends when one place stands out.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rmw_manycore_py.ndt.geometry.arrays import Matrix, Pose

REACH_DEVIATIONS = 2.0  # distance that is searched and allowed, in standard deviations
BASIN_M = 2.5  # smaller deviations need no search: alignments converge from there
STEP_M = 3.0  # between places that are tried
MAX_PLACES = 41


@dataclass(frozen=True)
class Along:
    """An axis in the map (2,), of length 1, and the standard deviation of the position along it."""

    axis: Matrix
    deviation_m: float

    @property
    def reach_m(self) -> float:
        """Return how far away along the axis a pose is allowed."""
        return REACH_DEVIATIONS * self.deviation_m

    @property
    def is_open(self) -> bool:
        """Return whether several places along the axis have to be tried."""
        return self.deviation_m > BASIN_M

    @property
    def covariance_m2(self) -> Matrix:
        """Return the covariance (2, 2) of x and y."""
        covariance: Matrix = self.deviation_m**2 * np.outer(self.axis, self.axis)
        return covariance

    def nearest(self, expected: Pose, T: Pose) -> Pose:
        """Return the pose within reach of the expected one that is nearest to another."""
        offset_m = self.offset_m(expected, T)
        return self.moved(expected, float(np.clip(offset_m, -self.reach_m, self.reach_m)))

    def offset_m(self, T: Pose, other: Pose) -> float:
        """Return how far along the axis another pose is."""
        return float((other[:2, 3] - T[:2, 3]) @ self.axis)

    def moved(self, T: Pose, distance_m: float) -> Pose:
        """Return a pose moved along the axis."""
        moved: Pose = T.copy()
        moved[:2, 3] += distance_m * self.axis
        return moved

    def places(self, middle: Pose) -> list[Pose]:
        """Return poses within reach of the middle one, nearest first."""
        count = min(int(self.reach_m / STEP_M), (MAX_PLACES - 1) // 2)
        steps = sorted(range(-count, count + 1), key=abs)
        step_m = self.reach_m / max(count, 1)
        return [self.moved(middle, step * step_m) for step in steps]
