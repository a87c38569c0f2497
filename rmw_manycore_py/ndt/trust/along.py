# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A direction in which a position is uncertain: along a tunnel, or a gap without scans; or two.

Scans do not constrain it, or several places along it fit. It ends when one place stands out.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import product

import numpy as np

from rmw_manycore_py.ndt.geometry.arrays import Matrix, Pose

REACH_DEVIATIONS = 2.0  # distance that is searched and allowed, in standard deviations
BASIN_M = 2.5  # smaller deviations need no search: alignments converge from there
STEP_M = 3.0  # between places that are tried
MAX_PLACES, MAX_ROWS = 41, 2


@dataclass(frozen=True)
class Along:
    """An axis in the map (2,), of length 1, and the standard deviations along and across it.

    :param across_m: 0 where scans constrain the position across the axis.
    """

    axis: Matrix
    deviation_m: float
    across_m: float = 0.0

    @property
    def across(self) -> Matrix:
        """Return the other axis (2,)."""
        return np.array([-self.axis[1], self.axis[0]])

    @property
    def reach_m(self) -> float:
        """Return how far away along the axis a pose is allowed."""
        return REACH_DEVIATIONS * self.deviation_m

    @property
    def is_open(self) -> bool:
        """Return whether several places have to be tried."""
        return max(self.deviation_m, self.across_m) > BASIN_M

    @property
    def covariance_m2(self) -> Matrix:
        """Return the covariance (2, 2) of x and y."""
        along_m2 = self.deviation_m**2 * np.outer(self.axis, self.axis)
        across_m2 = self.across_m**2 * np.outer(self.across, self.across)
        covariance: Matrix = along_m2 + across_m2
        return covariance

    def joined(self, other: Along) -> Along:
        """Return the larger uncertainty, and that of the other one across its axis."""
        main, second = (self, other) if self.deviation_m >= other.deviation_m else (other, self)
        across_m = float(np.sqrt(main.across @ second.covariance_m2 @ main.across))
        return replace(main, across_m=max(main.across_m, across_m))

    def nearest(self, expected: Pose, T: Pose) -> Pose:
        """Return the pose within reach of the expected one that is nearest to another."""
        nearest: Pose = T.copy()
        offset_m = T[:2, 3] - expected[:2, 3]
        nearest[:2, 3] -= self.beyond_m(offset_m, REACH_DEVIATIONS)
        nearest[2:, 3], nearest[:3, :3] = expected[2:, 3], expected[:3, :3]
        return nearest

    def beyond_m(self, offset_m: Matrix, deviations: float) -> Matrix:
        """Return what of an offset (2,) is beyond some standard deviations."""
        beyond_m: Matrix = offset_m.copy()
        for axis, deviation_m in ((self.axis, self.deviation_m), (self.across, self.across_m)):
            reach_m = deviations * deviation_m
            beyond_m -= np.clip(offset_m @ axis, -reach_m, reach_m) * axis
        return beyond_m

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
        rows = min(int(REACH_DEVIATIONS * self.across_m / STEP_M), MAX_ROWS)
        count = min(int(self.reach_m / STEP_M), (MAX_PLACES // (2 * rows + 1) - 1) // 2)
        step_m = self.reach_m / max(count, 1)
        row_m = REACH_DEVIATIONS * self.across_m / max(rows, 1)
        found = []
        for step, row in sorted(
            product(range(-count, count + 1), range(-rows, rows + 1)),
            key=lambda at: (abs(at[0]), abs(at[1])),
        ):
            place = self.moved(middle, step * step_m)
            place[:2, 3] += row * row_m * self.across
            found.append(place)
        return found
