# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Precision of positions: maps may be far from their origin, as in UTM coordinates.

No origin shift is applied: files, topics and poses share the map frame. Positions are float32 only
if that rounds them by at most a millimetre.
"""

from __future__ import annotations

import numpy as np

from rmw_manycore_py.ndt.geometry.arrays import Points

FARTHEST_SINGLE_M = 32768.0  # spacing of float32 is 2 mm just below


def reach_m(points: Points) -> float:
    """Return the largest absolute coordinate of the finite points (N, 3)."""
    # min and max, since abs() would copy a map of a gigabyte.
    ends = [float(end(points, where=np.isfinite(points), initial=0.0)) for end in (np.min, np.max)]
    return max(-ends[0], ends[1])


def needs_doubles(points: Points) -> bool:
    """Return whether float32 would round points (N, 3) by more than a millimetre."""
    return points.dtype == np.float64 and reach_m(points) >= FARTHEST_SINGLE_M


def narrowed(points: Points) -> Points:
    """Return points (N, 3) as float32 if that loses nothing: some programs write only doubles."""
    with np.errstate(over="ignore"):
        singles = points.astype(np.float32)
    return singles if np.array_equal(singles, points, equal_nan=True) else points


def why_coarse(points: Points) -> str:
    """Return a warning if float32 has made points (N, 3) coarse; "" otherwise."""
    farthest_m = reach_m(points)
    if points.dtype != np.float32 or farthest_m < FARTHEST_SINGLE_M:
        return ""
    step_m = float(np.spacing(np.float32(farthest_m)))
    return (
        f"its coordinates reach {farthest_m:.0f} m in single precision, which knows only every "
        f"{step_m:.3g} m there: give them as doubles (PCD: SIZE 8, PLY: double, npz: float64, "
        "PointCloud2: FLOAT64), or map and poses nearer to the origin"
    )
