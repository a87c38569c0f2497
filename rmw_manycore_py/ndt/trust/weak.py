# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Directions in which a scan does not constrain the position: along a tunnel, all over a square.

The curvature of the score says so, but not where most points are on the ground: the voxels of a
map cut it into a pattern that attracts the ground's own points. So where the curvature is doubtful,
what stands above the ground has to constrain the position by itself.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rmw_manycore_py.ndt.geometry.arrays import Matrix
from rmw_manycore_py.ndt.matching.alignment import Alignment

# Minimum spread of a whole scan that does not constrain the position along a street. It is 0.14 to
# 0.48 on streets, also repetitive ones, and recorded scans; 0.62 and more in a bare tunnel.
WEAK_SPREAD_M = 0.55
# The same of what stands above the ground: up to 0.43 on streets and in forests, 0.52 and more on
# squares and motorways. There it holds less than this share of what seems to constrain the
# position; elsewhere more, mostly two thirds.
RAISED_SPREAD_M, RAISED_SHARE = 0.5, 0.4


@dataclass(frozen=True)
class Weak:
    """The direction (2,) that is constrained least, and whether no other is constrained either."""

    axis: Matrix
    is_all: bool


def weak_directions(alignment: Alignment) -> Weak | None:
    """Return what a scan leaves open; None if it constrains x and y."""
    whole_m2, raised_m2 = alignment.xy_spread_m2, alignment.raised_spread_m2
    if raised_m2 is not None:
        values, vectors = np.linalg.eigh(raised_m2)
        shares = [float(axis @ whole_m2 @ axis) for axis in vectors.T] / values
        is_weak = (values > RAISED_SPREAD_M**2) & (shares < RAISED_SHARE)
        if is_weak[1]:
            return Weak(vectors[:, 1], bool(is_weak[0]))
    values, vectors = np.linalg.eigh(whole_m2)
    return Weak(vectors[:, 1], is_all=False) if values[1] > WEAK_SPREAD_M**2 else None
