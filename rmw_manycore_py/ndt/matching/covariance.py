# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Estimates the covariance of x and y from the surroundings of the result.

Both methods are those of Autoware's `ndt_scan_matcher`. In a tunnel, alignments started along it
end at different places, and the score there is as good as at the result: x along it is unknown.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from rmw_manycore_py.ndt.geometry.arrays import Matrix, Matrix6, Pose
from rmw_manycore_py.ndt.matching.alignment import Alignment
from rmw_manycore_py.ndt.matching.options import Offsets


def poses_around(T_map_sensor: Pose, offsets_m: Offsets) -> list[Pose]:
    """Return poses (4, 4) at the given offsets ahead of and to the left of a pose."""
    found = []
    for offset in offsets_m:
        T = T_map_sensor.copy()
        T[:2, 3] += T_map_sensor[:2, :2] @ offset
        found.append(T)
    return found


def from_results(result: Alignment, results: Sequence[Pose]) -> Matrix6:
    """Return the result's covariance (6, 6), x and y from the scatter of results around it.

    As in Autoware, the mean square deviation is multiplied by (n - 1) / n, n being the number of
    alignments including the first.
    """
    places = _places(result, results)
    count = len(places)
    scatter = _scatter(places, np.full(count, 1 / count))
    return _with_xy(result.covariance, scatter * (count - 1) / count)


def from_likelihoods(
    result: Alignment, poses: Sequence[Pose], likelihoods: Sequence[float], temperature: float
) -> Matrix6:
    """Return the result's covariance (6, 6), x and y from the likelihoods of poses around it.

    Each pose is weighted by exp(likelihood / temperature), with the nearest-voxel likelihood of
    :class:`Score`.
    """
    weights = _weights([result.nearest_voxel_likelihood, *likelihoods], temperature)
    return _with_xy(result.covariance, _scatter(_places(result, poses), weights))


def _places(result: Alignment, poses: Sequence[Pose]) -> Matrix:
    """Return x and y (n, 2) of the result and the poses around it."""
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
