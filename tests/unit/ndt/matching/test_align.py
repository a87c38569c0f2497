# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The one call that aligns a scan."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from rmw_manycore_py import ManycoreError, ndt
from support.samples.ndt_world import errors, pose, scan_at, street

pytestmark = pytest.mark.unit

MAP = street()
TRUTH = pose(40.0, 1.0, 1.8, 0.0, 0.0, 0.1)
GUESS = pose(40.6, 0.7, 1.8, 0.0, 0.0, 0.06)
SCAN = scan_at(MAP, TRUTH)


def test_a_scan_is_aligned() -> None:
    result = ndt.align(MAP, SCAN, GUESS)
    distance_m, angle_deg = errors(result.T_map_sensor, TRUTH)
    assert result.converged
    assert result.score > 0
    assert distance_m < 0.05
    assert angle_deg < 0.2


def test_lists_and_a_map_made_before_give_the_same() -> None:
    voxel_map = ndt.VoxelMap.from_points(MAP)
    first = ndt.align(MAP, SCAN, GUESS)
    for scan, guess in ((SCAN, GUESS), (SCAN.tolist(), GUESS.tolist())):
        again = ndt.align(voxel_map, scan, guess)
        assert np.array_equal(again.T_map_sensor, first.T_map_sensor)
        assert again.score == first.score


def test_options_are_those_of_the_map() -> None:
    options = ndt.MatcherOptions(voxel_size_m=1.0)
    voxel_map = ndt.VoxelMap.from_points(MAP, options)
    found = ndt.align(voxel_map, SCAN, GUESS)
    assert np.array_equal(
        found.T_map_sensor, ndt.align(MAP, SCAN, GUESS, options=options).T_map_sensor
    )
    with pytest.raises(ManycoreError, match="voxel_size_m"):
        ndt.align(voxel_map, SCAN, GUESS, options=ndt.MatcherOptions())


def test_points_that_are_not_finite_are_left_out() -> None:
    holes = np.concatenate([SCAN, np.full((100, 3), np.nan, np.float32)])
    found = ndt.align(MAP, holes, GUESS)
    assert np.array_equal(found.T_map_sensor, ndt.align(MAP, SCAN, GUESS).T_map_sensor)


@pytest.mark.parametrize("scan", [np.full((10, 3), np.nan), np.zeros((0, 3))])
def test_a_scan_of_nothing_does_not_converge(scan: Any) -> None:
    found = ndt.align(MAP, scan, GUESS)
    assert not found.converged
    assert found.why
    assert np.array_equal(found.T_map_sensor, GUESS)


SKEWED = np.diag([1.0, 1.0, 2.0, 1.0])
NO_POSE = GUESS.copy()
NO_POSE[0, 3] = np.nan


@pytest.mark.parametrize(
    ("target", "scan", "guess", "problem"),
    [
        (MAP, SCAN, NO_POSE, "T_map_guess: it is not finite"),
        (MAP, SCAN, SKEWED, "T_map_guess: it holds no rotation"),
        (MAP, SCAN, np.eye(3), r"expected shape \(4, 4\), found \(3, 3\)"),
        (MAP, SCAN, "here", "T_map_guess: expected real numbers"),
        (MAP, SCAN[:, :2], GUESS, r"scan: expected shape \(N, 3\), found \(\d+, 2\)"),
        (MAP, SCAN[0], GUESS, r"scan: expected shape \(N, 3\), found \(3,\)"),
        (MAP, SCAN.astype(complex), GUESS, "scan: expected real numbers .* found elements of comp"),
        (MAP, [[1.0, 2.0], [3.0]], GUESS, r"scan: expected real numbers of shape \(N, 3\)"),
        (MAP.T, SCAN, GUESS, r"target: expected shape \(N, 3\), found \(3, \d+\)"),
        (MAP[:0], SCAN, GUESS, "voxel"),
        (np.full((100, 3), np.nan), SCAN, GUESS, "voxel"),
    ],
)
def test_what_cannot_be_aligned_is_an_error(
    target: Any, scan: Any, guess: Any, problem: str
) -> None:
    with pytest.raises(ManycoreError, match=problem):
        ndt.align(target, scan, guess)


MATCHER = ndt.SerialMatcher()
MATCHER.set_map(ndt.VoxelMap.from_points(MAP))


@pytest.mark.parametrize(
    ("value", "found"),
    [
        ([["a", "b", "c"]], "elements of <U1"),
        ("here", "elements of <U4"),
        ([[1.0, 2.0], [3.0]], "rows of different lengths"),
        ([[1.0, None, 3.0]], "elements of object"),
        ([[10**400, 1, 2]], "elements of object"),
        (SCAN.astype(complex), "elements of complex"),
    ],
)
@pytest.mark.parametrize(
    ("call", "expected"),
    [
        (ndt.VoxelMap.from_points, r"points: expected real numbers of shape \(N, 3\)"),
        (lambda value: MATCHER.align(value, GUESS), r"points: expected .* shape \(N, 3\)"),
        (lambda value: MATCHER.align(SCAN, value), r"pose: expected .* shape \(4, 4\)"),
        (lambda value: ndt.align(value, SCAN, GUESS), r"target: expected .* shape \(N, 3\)"),
    ],
    ids=["map", "scan", "guess", "align"],
)
def test_arrays_of_no_numbers_are_an_error_of_ours(
    call: Callable[[Any], Any], value: Any, expected: str, found: str
) -> None:
    with pytest.raises(ManycoreError, match=f"{expected}, found {found}"):
        call(value)
