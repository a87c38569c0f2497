# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""From the kernel's numbers to answers."""

from __future__ import annotations

from typing import Any

import numpy as np

from rmw_manycore_py.ndt.geometry.arrays import Matrix6, Pose
from rmw_manycore_py.ndt.matching.alignment import Alignment, Score
from rmw_manycore_py.ndt.matching.options import MatcherOptions

WHY = {
    "converged": "",
    "iteration_limit": "still moving after max_iterations steps",
    "no_overlap": "no point of the scan lies in the map: wrong guess, or a map of another place",
    "degenerate": "the scan does not say where it fits: too few points, or too far from the map",
}


def score_from(numbers: dict[str, Any]) -> Score:
    """Return the score that the kernel found."""
    seen, points = numbers["points"], numbers["used_points"]
    return Score(
        score=numbers["score"],
        transform_probability=numbers["score"] / points if points else 0.0,
        nearest_voxel_likelihood=numbers["nearest"] / seen if seen else 0.0,
        points_in_map=int(seen),
    )


def alignment_from(numbers: dict[str, Any], options: MatcherOptions) -> Alignment:
    """Return the alignment that the kernel found.

    A pose from which the score does not fall in all directions is no result: scans of a few points
    have no best place.
    """
    score = score_from(numbers)
    values, vectors = np.linalg.eigh(-np.array(numbers["hessian"]))
    is_maximum = bool(values[0] > 0)
    ended = numbers["outcome"]
    outcome = "degenerate" if ended == "converged" and not is_maximum else ended
    covariance: Matrix6 = np.diag(options.fixed_pose_variances)
    if options.pose_covariance == "laplace" and is_maximum:
        covariance = (vectors / values) @ vectors.T
    return Alignment(
        T_map_sensor=np.array(numbers["pose"]).reshape(4, 4),
        covariance=covariance,
        iterations=numbers["iterations"],
        score=score.score,
        transform_probability=score.transform_probability,
        nearest_voxel_likelihood=score.nearest_voxel_likelihood,
        converged=outcome == "converged",
        why=WHY[outcome],
    )


def refused(guess: Pose | None, why: str, options: MatcherOptions) -> Alignment:
    """Return the answer to what cannot be aligned at all."""
    return Alignment(
        T_map_sensor=np.eye(4) if guess is None else guess.copy(),
        covariance=np.diag(options.fixed_pose_variances),
        iterations=0,
        score=0.0,
        transform_probability=0.0,
        nearest_voxel_likelihood=0.0,
        converged=False,
        why=why,
    )
