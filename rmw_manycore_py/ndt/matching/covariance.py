# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Estimates the covariance of x and y from the surroundings of the result.

Both methods are those of Autoware's `ndt_scan_matcher`. In a tunnel, alignments started along it
end at different places, and the score there is as good as at the result: x along it is unknown.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from rmw_manycore_py.ndt.geometry.arrays import Matrix, Matrix6, Pose
from rmw_manycore_py.ndt.matching.alignment import Alignment
from rmw_manycore_py.ndt.matching.options import MatcherOptions, Offsets


def estimated(
    alignment: Alignment,
    options: MatcherOptions,
    align: Callable[[Pose], Pose],
    likelihood: Callable[[Pose], float],
) -> Alignment:
    """Return an alignment with the covariance that the options ask for.

    :param align: returns the result of an alignment from a pose (4, 4).
    :param likelihood: returns the nearest-voxel likelihood at a pose (4, 4).
    """
    kind = options.pose_covariance
    if alignment.is_degenerate or kind not in ("multi_ndt", "multi_ndt_score"):
        return alignment
    around = poses_around(alignment.T_map_sensor, options.offsets_m)
    results: list[Pose] = []
    if kind == "multi_ndt":
        results = [align(T) for T in around]
        found = from_results(alignment, results)
    else:
        likelihoods = [likelihood(T) for T in around]
        found = from_likelihoods(alignment, around, likelihoods, options.temperature)
    return replace(
        alignment,
        covariance=found,
        guesses_around=tuple(around),
        results_around=tuple(results),
    )


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
