# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Converts the parameters of a node to options of a matcher."""

from __future__ import annotations

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.ndt.matching.options import MatcherOptions, Offsets, PoseCovariance
from rmw_manycore_py.ndt.nodes.scan_matcher.parameters import (
    FIXED_VALUE,
    LAPLACE_APPROXIMATION,
    MULTI_NDT,
    MULTI_NDT_SCORE,
    MatcherParameters,
    OwnParameters,
)

POSE_COVARIANCES: dict[int, PoseCovariance] = {
    FIXED_VALUE: "fixed",
    LAPLACE_APPROXIMATION: "laplace",
    MULTI_NDT: "multi_ndt",
    MULTI_NDT_SCORE: "multi_ndt_score",
}


def matcher_options(parameters: MatcherParameters, own: OwnParameters) -> MatcherOptions:
    """Return the options of matcher and voxel map; the behaviour supplies unset values."""
    as_autoware = own.behaviour == "autoware"
    return MatcherOptions(
        voxel_size_m=parameters.resolution_m,
        coarse_levels=() if as_autoware else own.coarse_levels,
        wide_levels=() if as_autoware else own.wide_levels,
        polish_levels=own.polish_levels,
        search=own.search,
        voxel_covariance=own.voxel_covariance or ("autoware" if as_autoware else "pcl"),
        step_rule=own.step_rule or ("clamped" if as_autoware else "trust_region"),
        step_size=parameters.step_size,
        trans_epsilon=parameters.trans_epsilon,
        max_iterations=parameters.max_iterations,
        outlier_ratio=own.outlier_ratio,
        regularization_scale_factor=(
            parameters.regularization_scale if parameters.regularization else 0.0
        ),
        pose_covariance=POSE_COVARIANCES[parameters.covariance_type],
        offsets_m=_offsets(parameters),
        temperature=parameters.temperature,
    )


def _offsets(parameters: MatcherParameters) -> Offsets:
    x_m, y_m = parameters.offsets_x_m, parameters.offsets_y_m
    if len(x_m) != len(y_m) or not x_m:
        raise ManycoreError(
            "parameters covariance.covariance_estimation.initial_pose_offset_model_x and _y: "
            f"expected equally many numbers in both, found {len(x_m)} and {len(y_m)}",
            EXIT_BAD_INPUT,
        )
    return tuple(zip(x_m, y_m, strict=True))
