# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""From the parameters of a node to the options of a matcher."""

from __future__ import annotations

from rmw_manycore_py.ndt.nodes.matcher_parameters import MatcherParameters, OwnParameters
from rmw_manycore_py.ndt.options import MatcherOptions


def matcher_options(parameters: MatcherParameters, own: OwnParameters) -> MatcherOptions:
    """Return the options of matcher and voxel map."""
    return MatcherOptions(
        voxel_size_m=parameters.resolution_m,
        search=own.search,
        voxel_covariance=own.voxel_covariance,
        step_size=parameters.step_size,
        trans_epsilon=parameters.trans_epsilon,
        max_iterations=parameters.max_iterations,
        outlier_ratio=own.outlier_ratio,
        regularization_scale_factor=parameters.regularization_scale,
    )
