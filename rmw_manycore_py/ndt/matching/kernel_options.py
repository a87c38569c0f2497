# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Options as the kernel takes them."""

from __future__ import annotations

from rmw_manycore_py import _ndt
from rmw_manycore_py.ndt.matching.options import MatcherOptions

# Coarse voxels are as thick as this share of their size: a wall pulls from farther off than it is
# thick. Of 0, 0.05, 0.075, 0.1 and 0.125 the best on recorded scans and synthetic streets.
COARSE_THICKNESS = 0.1


def map_options(options: MatcherOptions) -> _ndt.MapOptions:
    """Return what the finest level is built with."""
    return _ndt.MapOptions(
        voxel_size_m=options.voxel_size_m,
        search=options.search,
        covariance=options.voxel_covariance,
        min_points_per_voxel=options.min_points_per_voxel,
        widening_m=0.0,
    )


def coarse_options(options: MatcherOptions, factor: float) -> _ndt.MapOptions:
    """Return what a level is built with whose voxels are `factor` times as large.

    Its search is direct7 whatever the finest level's is: half the work of radius, and it found home
    from farther off.
    """
    voxel_size_m = factor * options.voxel_size_m
    return _ndt.MapOptions(
        voxel_size_m=voxel_size_m,
        search="direct7",
        covariance=options.voxel_covariance,
        min_points_per_voxel=options.min_points_per_voxel,
        widening_m=COARSE_THICKNESS * voxel_size_m,
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
