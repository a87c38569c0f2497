# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Converts options to those of the kernel."""

from __future__ import annotations

from rmw_manycore_py.native import _ndt
from rmw_manycore_py.ndt.matching.options import MatcherOptions

# Minimum thickness of coarse voxels relative to their size: a wall then attracts from farther than
# its thickness. Best of 0, 0.05, 0.075, 0.1 and 0.125 on recorded scans and synthetic streets.
COARSE_THICKNESS = 0.1


def map_options(options: MatcherOptions) -> _ndt.MapOptions:
    """Return the build options of the finest level."""
    return _ndt.MapOptions(
        voxel_size_m=options.voxel_size_m,
        search=options.search,
        covariance=options.voxel_covariance,
        min_points_per_voxel=options.min_points_per_voxel,
        widening_m=0.0,
    )


def coarse_options(options: MatcherOptions, factor: float) -> _ndt.MapOptions:
    """Return the build options of a level with voxels `factor` times as large.

    Always searches direct7: half the work of radius, and a larger basin of convergence.
    """
    voxel_size_m = factor * options.voxel_size_m
    return _ndt.MapOptions(
        voxel_size_m=voxel_size_m,
        search="direct7",
        covariance=options.voxel_covariance,
        min_points_per_voxel=options.min_points_per_voxel,
        widening_m=COARSE_THICKNESS * voxel_size_m,
    )


def polish_options(options: MatcherOptions, factor: float) -> _ndt.MapOptions:
    """Return the build options of a level that refines poses.

    Always searches direct7, as coarse levels do: no score is taken from it. Its covariance is
    always PCL's: the identity of the others widens small voxels, of few points, beyond their own
    size.
    """
    return _ndt.MapOptions(
        voxel_size_m=factor * options.voxel_size_m,
        search="direct7",
        covariance="pcl",
        min_points_per_voxel=options.min_points_per_voxel,
        widening_m=0.0,
    )


def match_options(options: MatcherOptions) -> _ndt.MatchOptions:
    """Return the options of matching."""
    return _ndt.MatchOptions(
        step_rule=options.step_rule,
        max_iterations=options.max_iterations,
        step_size=options.step_size,
        trans_epsilon=options.trans_epsilon,
        outlier_ratio=options.outlier_ratio,
        regularization_scale_factor=options.regularization_scale_factor,
    )
