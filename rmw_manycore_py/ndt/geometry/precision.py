# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""How precisely positions are kept: maps may lie far from their origin, as in UTM coordinates.

Nothing is moved nearer to the origin: files, topics and poses are in the same map frame. Positions
are in single precision only where that rounds them by at most a millimetre.
"""

from __future__ import annotations

import numpy as np

from rmw_manycore_py.ndt.geometry.arrays import Points

FARTHEST_SINGLE_M = 32768.0  # below, two neighbouring single-precision numbers are 2 mm apart


def reach_m(points: Points) -> float:
    """Return the largest coordinate of points (N, 3), without its sign; those that are finite."""
    # The smallest and the largest, as abs() would copy a map of a gigabyte.
    ends = [float(end(points, where=np.isfinite(points), initial=0.0)) for end in (np.min, np.max)]
    return max(-ends[0], ends[1])


def needs_doubles(points: Points) -> bool:
    """Tell whether points (N, 3) would be rounded by more than a millimetre as single precision."""
    return points.dtype == np.float64 and reach_m(points) >= FARTHEST_SINGLE_M


def as_they_were(points: Points) -> Points:
    """Return doubles (N, 3) that were singles before a reader widened them as singles again."""
    with np.errstate(over="ignore"):
        singles = points.astype(np.float32)
    return singles if np.array_equal(singles, points, equal_nan=True) else points


def why_coarse(points: Points) -> str:
    """Return what single precision has made of points (N, 3), "" where it made no difference."""
    farthest_m = reach_m(points)
    if points.dtype != np.float32 or farthest_m < FARTHEST_SINGLE_M:
        return ""
    step_m = float(np.spacing(np.float32(farthest_m)))
    return (
        f"its coordinates reach {farthest_m:.0f} m in single precision, which knows only every "
        f"{step_m:.3g} m there: give them as doubles (PCD: SIZE 8, PLY: double, npz: float64, "
        "PointCloud2: FLOAT64), or map and poses nearer to the origin"
    )
