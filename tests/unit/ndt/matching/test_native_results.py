# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Options passed to the native kernel, and results returned by it."""

from __future__ import annotations

import gc

import numpy as np
import pytest

from rmw_manycore_py.native import _ndt
from rmw_manycore_py.ndt import MatcherOptions
from rmw_manycore_py.ndt.geometry.arrays import map_points, scan_points
from rmw_manycore_py.ndt.matching.kernel_options import coarse_options, map_options, match_options
from support.samples.ndt_world import pose, scan_at, street

pytestmark = pytest.mark.unit

OPTIONS = MatcherOptions()
WORLD = street()
TRUE = pose(40, 0.5, 1.8, 0.01, -0.02, 0.3)
GUESS = pose(40.3, 0.3, 1.9, 0.01, -0.02, 0.3)
SCAN = scan_points(scan_at(WORLD, TRUE)[::7])


@pytest.fixture(scope="module")
def voxel_map() -> _ndt.VoxelMap:
    return _ndt.VoxelMap(map_points(WORLD), map_options(OPTIONS))


def test_a_result_holds_pose_outcome_and_derivatives(voxel_map: _ndt.VoxelMap) -> None:
    matcher = _ndt.SerialMatcher(match_options(OPTIONS))
    result = matcher.align([voxel_map], SCAN, GUESS)
    assert result.outcome == "converged"
    assert 0 < result.iterations < OPTIONS.max_iterations
    assert np.abs(result.pose[:3, 3] - TRUE[:3, 3]).max() < 0.1
    at = matcher.evaluate([voxel_map], SCAN, result.pose)
    assert result.at.score == pytest.approx(at.score)
    assert (result.at.scan_points, at.scan_points) == (len(SCAN), len(SCAN))
    assert 0 < at.points <= at.pairs
    assert at.points <= len(SCAN)


def test_arrays_outlive_the_result_that_they_are_of(voxel_map: _ndt.VoxelMap) -> None:
    matcher = _ndt.SerialMatcher(match_options(OPTIONS))
    found = matcher.evaluate([voxel_map], SCAN, GUESS)
    gradient, hessian = found.gradient, found.hessian
    expected = gradient.tolist(), hessian.tolist()
    assert (gradient.shape, hessian.shape, hessian.dtype) == ((6,), (6, 6), np.float64)
    assert np.array_equal(hessian, hessian.T)
    del found
    gc.collect()
    others = [matcher.evaluate([voxel_map], SCAN, TRUE) for _ in range(100)]  # where it was
    assert (gradient.tolist(), hessian.tolist()) == expected
    assert others[0].gradient.tolist() != expected[0]
    with pytest.raises(ValueError, match="read-only"):
        gradient[0] = 0


def test_a_scan_of_no_points_has_no_overlap(voxel_map: _ndt.VoxelMap) -> None:
    matcher = _ndt.SerialMatcher(match_options(OPTIONS))
    result = matcher.align([voxel_map], SCAN[:0], GUESS)
    assert (result.outcome, result.at.scan_points, result.at.points) == ("no_overlap", 0, 0)


def test_the_kernel_has_no_defaults_of_its_own() -> None:
    with pytest.raises(TypeError):
        _ndt.MatchOptions()  # type: ignore[call-arg]
    words = r"^search: expected 'radius', 'direct7' or 'direct1', found 'kdtree'$"
    with pytest.raises(ValueError, match=words):
        _ndt.MapOptions(
            voxel_size_m=2.0,
            search="kdtree",  # type: ignore[arg-type]
            covariance="pcl",
            min_points_per_voxel=6,
            widening_m=0.0,
        )


def test_a_coarse_level_pulls_from_farther_off_than_its_points_are_thick() -> None:
    """1.2 m above a plane, the finest level has no gradient."""
    options = MatcherOptions(search="direct7")
    ground = np.random.default_rng(1).uniform((-20, -20, -0.02), (20, 20, 0.02), (20_000, 3))
    scan = scan_points(ground[::10])
    above = pose(0, 0, 1.2, 0, 0, 0)
    matcher = _ndt.SerialMatcher(match_options(options))

    def pull(chosen: _ndt.MapOptions) -> float:
        level = _ndt.VoxelMap(map_points(ground), chosen)
        return float(matcher.evaluate([level], scan, above).gradient[2]) / len(scan)

    assert pull(coarse_options(options, 2.0)) < -0.1
    assert abs(pull(map_options(options))) < 1e-3
