# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The points of a scan that no vehicle can have: on the ground, or above the highest truck.

Sides and roofs that the map lacks drag an alignment up and aside, most of all on coarse levels. The
ground is that of the scan itself, so neither map nor place have to be known:

```
 height      •  •          kept
 3.7 m ─────────────────
          ▄▄▄▄  roof, side, but also the lower part of walls: left out
 0.4 m ─────────────────
 ground  ••    •••••       kept
```
"""

from __future__ import annotations

from itertools import product

import numpy as np

from rmw_manycore_py.ndt.geometry.arrays import Pose, ScanPoints

LOWEST_M, HIGHEST_M = 0.4, 3.7  # of what may be a vehicle, above the ground
# The ground is the lowest point of a column and of those around: beside a vehicle it is seen.
COLUMN_M = 2.0
FARTHEST_M = 1e6  # beyond, a driver's points are as good as missing


def beyond_vehicles(scan: ScanPoints, T_map_sensor: Pose) -> ScanPoints:
    """Return the points of a scan (N, 3) [m, sensor frame] that are not at a vehicle's height.

    :param T_map_sensor: (4, 4), of which the tilt counts: a few degrees off are good enough.
    """
    near = np.abs(scan).max(axis=1, initial=0.0) < FARTHEST_M  # so not for NaN
    seen = scan[near]
    upright = seen @ T_map_sensor[:3, :3].T.astype(np.float32)
    height_m = upright[:, 2] - _ground_m(upright)
    kept: ScanPoints = np.ascontiguousarray(seen[(height_m < LOWEST_M) | (height_m > HIGHEST_M)])
    return kept


def _ground_m(points: ScanPoints) -> ScanPoints:
    """Return for each point (N, 3) the lowest z around it."""
    columns = np.floor(points[:, :2] / COLUMN_M).astype(np.int64)
    row = int(4 * FARTHEST_M / COLUMN_M)  # a turn may lead farther along an axis
    found, of_point = np.unique(columns[:, 0] * row + columns[:, 1], return_inverse=True)
    lowest_m = np.full(len(found), np.inf, np.float32)
    np.minimum.at(lowest_m, of_point, points[:, 2])
    around_m = lowest_m.copy()
    for x, y in product((-1, 0, 1), repeat=2):
        beside = found + x * row + y
        at = np.minimum(np.searchsorted(found, beside), len(found) - 1)
        there = found[at] == beside
        around_m[there] = np.minimum(around_m[there], lowest_m[at[there]])
    ground_m: ScanPoints = around_m[of_point]
    return ground_m
