# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Whether the result of an alignment is reliable, and its covariance."""

from __future__ import annotations

import numpy as np

from rmw_manycore_py.ndt.geometry.arrays import Matrix
from rmw_manycore_py.ndt.matching.alignment import Alignment
from rmw_manycore_py.ndt.nodes.scan_matcher.diagnostics import Diagnostics
from rmw_manycore_py.ndt.nodes.scan_matcher.parameters import (
    FIXED_VALUE,
    TRANSFORM_PROBABILITY,
    MatcherParameters,
)
from rmw_manycore_py.ndt.nodes.scan_matcher.steps import has_ended


def is_reliable(
    alignment: Alignment, parameters: MatcherParameters, diagnostics: Diagnostics
) -> bool:
    """Return whether the alignment has converged with a score above the threshold."""
    diagnostics.value("iteration_num", alignment.iterations)
    if not alignment.converged:
        diagnostics.warn(f"no convergence after {alignment.iterations} iterations: {alignment.why}")
    diagnostics.value("transform_probability", alignment.transform_probability)
    likelihood = alignment.nearest_voxel_likelihood
    diagnostics.value("nearest_voxel_transformation_likelihood", likelihood)
    if parameters.converged_param_type == TRANSFORM_PROBABILITY:
        score, threshold = alignment.transform_probability, parameters.min_transform_probability
    else:
        score, threshold = likelihood, parameters.min_nearest_voxel_likelihood
    if not score > threshold:
        diagnostics.warn(f"the score {score:.3f} is not above the threshold {threshold:g}")
    return has_ended(alignment) and score > threshold


def output_covariance(alignment: Alignment, parameters: MatcherParameters) -> Matrix:
    """Return the covariance (6, 6) in the map frame.

    Fixed: the parameter, rotated from the vehicle's frame. Otherwise x and y are the alignment's,
    but at least the fixed ones along the vehicle's axes.
    """
    R = alignment.T_map_sensor[:3, :3]
    fixed: Matrix = np.asarray(parameters.covariance, np.float64).reshape(6, 6)
    covariance: Matrix = fixed.copy()
    covariance[:3, :3] = R @ fixed[:3, :3] @ R.T
    if parameters.covariance_type != FIXED_VALUE:
        yaw = np.arctan2(R[1, 0], R[0, 0])
        turn = np.array([[np.cos(yaw), -np.sin(yaw)], [np.sin(yaw), np.cos(yaw)]])
        estimated = turn.T @ (parameters.covariance_scale * alignment.covariance[:2, :2]) @ turn
        for axis in (0, 1):
            estimated[axis, axis] = max(estimated[axis, axis], fixed[axis, axis])
        covariance[:2, :2] = turn @ estimated @ turn.T
    return covariance
