# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""How well x and y are known, from what is found around the result.

Both ways are those of Autoware's `ndt_scan_matcher`. In a tunnel alignments from points along it
end at as many places, and the score is as good there as at the result: x along it is not known.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from rmw_manycore_py.ndt.geometry.arrays import Matrix, Matrix6, Pose
from rmw_manycore_py.ndt.matching.alignment import Alignment
from rmw_manycore_py.ndt.matching.options import Offsets


def poses_around(T_map_sensor: Pose, offsets_m: Offsets) -> list[Pose]:
    """Return poses (4, 4) that lie so far ahead and to the left of one."""
    found = []
    for offset in offsets_m:
        T = T_map_sensor.copy()
        T[:2, 3] += T_map_sensor[:2, :2] @ offset
        found.append(T)
    return found


def from_results(result: Alignment, results: Sequence[Pose]) -> Matrix6:
    """Return the result's covariance (6, 6), of x and y as results from around it scatter.

    The mean square deviation is multiplied by (n - 1) / n, n being the number of alignments with
    the first, as in Autoware.
    """
    places = _places(result, results)
    count = len(places)
    scatter = _scatter(places, np.full(count, 1 / count))
    return _with_xy(result.covariance, scatter * (count - 1) / count)


def from_likelihoods(
    result: Alignment, poses: Sequence[Pose], likelihoods: Sequence[float], temperature: float
) -> Matrix6:
    """Return the result's covariance (6, 6), of x and y from the likelihoods of poses around it.

    Each place weighs exp(likelihood / temperature), the likelihood being that of the nearest
    voxels (:class:`Score`).
    """
    weights = _weights([result.nearest_voxel_likelihood, *likelihoods], temperature)
    return _with_xy(result.covariance, _scatter(_places(result, poses), weights))


def _places(result: Alignment, poses: Sequence[Pose]) -> Matrix:
    """Return x and y (n, 2) of the result and of poses around it."""
    return np.array([T[:2, 3] for T in (result.T_map_sensor, *poses)])


def _weights(likelihoods: Sequence[float], temperature: float) -> Matrix:
    exponents = (np.array(likelihoods) - max(likelihoods)) / temperature
    weights: Matrix = np.exp(exponents) / np.exp(exponents).sum()
    return weights


def _scatter(places_m: Matrix, weights: Matrix) -> Matrix:
    deviations = places_m - weights @ places_m
    scatter: Matrix = (weights * deviations.T) @ deviations
    return scatter


def _with_xy(covariance: Matrix6, xy: Matrix) -> Matrix6:
    changed: Matrix6 = covariance.copy()
    changed[:2, :2] = xy
    return changed
