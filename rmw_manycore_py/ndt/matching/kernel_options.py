# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Options as the kernel takes them."""

from __future__ import annotations

from rmw_manycore_py import _ndt
from rmw_manycore_py.ndt.matching.options import MatcherOptions


def map_options(options: MatcherOptions, factor: float = 1.0) -> _ndt.MapOptions:
    """Return what a map is built with whose voxels are `factor` times as large."""
    return _ndt.MapOptions(
        voxel_size_m=factor * options.voxel_size_m,
        search=options.search,
        covariance=options.voxel_covariance,
        min_points_per_voxel=options.min_points_per_voxel,
    )


def match_options(options: MatcherOptions) -> _ndt.MatchOptions:
    """Return what scans are matched with."""
    return _ndt.MatchOptions(
        step_rule=options.step_rule,
        max_iterations=options.max_iterations,
        step_size=options.step_size,
        trans_epsilon=options.trans_epsilon,
        outlier_ratio=options.outlier_ratio,
        regularization_scale_factor=options.regularization_scale_factor,
    )
