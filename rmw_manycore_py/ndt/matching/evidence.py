# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""How well a scan fits the part of the map that can contradict it.

A mean over all points is low at right poses, too, where vehicles hide the surroundings or the map
ends. So points are classified:

- *unknown*: their column of the map is empty, or at the map's edge. They say nothing.
- *foreign*: they fit badly, and stand where a vehicle can. They neither fit nor contradict.
- *contradicting*: they fit badly higher up, or lie behind a surface of the map. Foreign objects
  shorten rays, they never let them through.
- the *rest*: its mean score is reduced by the share of contradicting points.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from rmw_manycore_py.native import _ndt
from rmw_manycore_py.ndt.geometry.arrays import Matrix, Pose, ScanPoints
from rmw_manycore_py.ndt.matching.voxel_map import VoxelMap

SAMPLE = 2000  # points of a scan that are looked at
FITS = 0.3  # minimum score of a point that fits, as a share of the map's own score
MAX_FOREIGN_M = 3.5  # height of a bus or truck above the ground, less half a voxel
MIN_COLUMNS_AROUND = 6  # of eight; a column at a straight edge has five
MIN_SUPPORT = 0.03  # minimum share of points above ground that fit
# Minimum height of what stands above the ground: a kerb does not, a guard rail does. The ground
# fits anywhere: it does not make up for contradictions.
RAISED_M = 0.4

Mask = npt.NDArray[np.bool_]


@dataclass(frozen=True)
class Evidence:
    """What the map says about N points.

    :param score: (N,) of the best voxel around each point; 0 without one.
    :param height_m: (N,) above the floor of the column.
    :param fits: (N,) whether a point is at something in the map.
    :param is_past: (N,) whether it lies behind a surface.
    :param rest: (N,) whether it is neither unknown nor foreign.
    """

    score: Matrix
    height_m: Matrix
    fits: Mask
    is_past: Mask
    rest: Mask

    @classmethod
    def of(
        cls, voxel_map: VoxelMap, scan: ScanPoints, T_map_sensor: Pose, outlier_ratio: float
    ) -> Evidence:
        """Classify the points of a scan (N, 3) [m, sensor frame] at a pose (4, 4)."""
        found = voxel_map.finest.point_evidence(scan, T_map_sensor, outlier_ratio)
        score, height_m, around, past = np.nan_to_num(found.astype(np.float64)).T
        fits = score >= FITS * voxel_map.own_score
        is_past = past > 0.0
        known = ~np.isnan(found[:, 1]) & (fits | (around >= MIN_COLUMNS_AROUND))
        stands = (height_m > 0.0) & (height_m < MAX_FOREIGN_M)
        return cls(score, height_m, fits, is_past, known & (fits | is_past | ~stands))

    @property
    def raised(self) -> Mask:
        """Return (N,) which points of the rest stand above the ground."""
        return self.rest & (self.height_m > RAISED_M)

    def explained_score(self) -> float:
        """Return the score of the rest, reduced by contradictions, to compare with a map's own."""
        supporting = int((self.raised & self.fits).sum())
        if supporting < MIN_SUPPORT * len(self.score):
            return 0.0
        contradicting = int((self.rest & ~self.fits & ~self.is_past).sum() + self.is_past.sum())
        mean = float(self.score[self.rest].mean())
        return mean * supporting / (supporting + contradicting)


def sample_of(scan: ScanPoints, fewest: int = SAMPLE) -> ScanPoints:
    """Return every nth point of a scan (N, 3), so that at least `fewest` remain.

    n is odd: a LiDAR of 16 to 128 rings may give the points column by column.
    """
    nth = len(scan) // fewest
    return np.ascontiguousarray(scan[:: max(1, nth - 1 | 1)])


def known_points(voxel_map: _ndt.VoxelMap, scan: ScanPoints, T_map_sensor: Pose) -> ScanPoints:
    """Return the points of a scan (N, 3) [m, sensor frame] that are not unknown at a pose (4, 4).

    An alignment gains by moving the others to where the map has something: they drag it there.
    """
    around = voxel_map.columns_around(scan, T_map_sensor)
    kept: ScanPoints = np.ascontiguousarray(scan[around >= MIN_COLUMNS_AROUND])
    return kept
