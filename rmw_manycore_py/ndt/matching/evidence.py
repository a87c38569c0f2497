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

import numpy as np

from rmw_manycore_py.native import _ndt
from rmw_manycore_py.ndt.geometry.arrays import Matrix, Pose, ScanPoints

# Minimum explained score of a convincing result, as a share of the map's own score. In the worlds
# of `manycore bench ndt --only trust` 96 % of the right poses have more. So has one of the wrong
# ones in the map, 0.64 m off where the map ends; the others have up to 0.873.
EXPLAINED_SHARE = 0.88
SAMPLE = 2000  # points of a scan that are looked at
FITS = 0.3  # minimum score of a point that fits, as a share of the map's own score
MAX_FOREIGN_M = 3.5  # height of a bus or truck above the ground, less half a voxel
ABOVE_GROUND_M = 1.2  # the ground fits anywhere: it does not make up for contradictions
MIN_COLUMNS_AROUND = 6  # of eight; a column at a straight edge has five
MIN_SUPPORT = 0.03  # minimum share of points above ground that fit


def explained_score(evidence: Matrix, own_score: float) -> float:
    """Return the score of the rest, reduced by contradictions; at most comparable to `own_score`.

    :param evidence: (N, 4) of `_ndt.VoxelMap.point_evidence`.
    :param own_score: of the map's own points.
    """
    score, height_m, around, is_past = np.nan_to_num(evidence).T
    fits = score >= FITS * own_score
    known = ~np.isnan(evidence[:, 1]) & (fits | (around >= MIN_COLUMNS_AROUND))
    is_past = is_past > 0.0
    stands = (height_m > 0.0) & (height_m < MAX_FOREIGN_M)
    foreign = known & ~fits & ~is_past & stands
    rest = known & ~foreign
    supporting = int((known & fits & (height_m > ABOVE_GROUND_M)).sum())
    if supporting < MIN_SUPPORT * len(evidence):
        return 0.0
    contradicting = int((rest & ~fits & ~is_past).sum() + is_past.sum())
    return float(score[rest].mean()) * supporting / (supporting + contradicting)


def known_points(voxel_map: _ndt.VoxelMap, scan: ScanPoints, T_map_sensor: Pose) -> ScanPoints:
    """Return the points of a scan (N, 3) [m, sensor frame] that are not unknown at a pose (4, 4).

    An alignment gains by moving the others to where the map has something: they drag it there.
    """
    around = voxel_map.columns_around(scan, T_map_sensor)
    kept: ScanPoints = np.ascontiguousarray(scan[around >= MIN_COLUMNS_AROUND])
    return kept
