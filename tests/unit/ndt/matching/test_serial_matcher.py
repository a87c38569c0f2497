# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The matcher converges, and reports what it cannot align."""

from __future__ import annotations

import importlib
from typing import Any, get_args

import numpy as np
import pytest

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.native.enums import Search, StepRule, VoxelCovariance
from rmw_manycore_py.ndt import MatcherOptions, SerialMatcher, VoxelMap
from support.samples.ndt_world import errors, pose, scan_at, street

pytestmark = pytest.mark.unit

WORLD = street()
TRUE = pose(40, 0.5, 1.8, 0.01, -0.02, 0.3)
GUESS = pose(40.4, 0.2, 1.9, 0, 0, 0.34)
SCAN = scan_at(WORLD, TRUE)


def matcher(**options: Any) -> SerialMatcher:
    chosen = MatcherOptions(**options)
    made = SerialMatcher(chosen)
    made.set_map(VoxelMap.from_points(WORLD, chosen))
    return made


@pytest.mark.parametrize("covariance", get_args(VoxelCovariance))
@pytest.mark.parametrize("rule", get_args(StepRule))
@pytest.mark.parametrize("search", get_args(Search))
def test_a_scan_finds_its_place(
    search: Search, rule: StepRule, covariance: VoxelCovariance
) -> None:
    with matcher(search=search, step_rule=rule, voxel_covariance=covariance) as found_by:
        found = found_by.align(SCAN, GUESS)
    assert found.converged, found.why
    distance_m, angle_deg = errors(found.T_map_sensor, TRUE)
    # With search `direct1` a point's score jumps at cell borders, and the best pose is less exact.
    assert distance_m < (0.08 if search == "direct1" else 0.06)
    assert angle_deg < (0.5 if search == "direct1" else 0.3)


def test_a_coarse_level_leads_home_from_far_off() -> None:
    """From 4 m and 14 degrees one level ends elsewhere; from nearby both end at the same pose."""
    far = TRUE @ pose(4, 0, 0, 0, 0, 0.25)
    alone, cascade = matcher(coarse_levels=()), matcher()
    assert errors(alone.align(SCAN, far).T_map_sensor, TRUE)[0] > 0.5
    found = cascade.align(SCAN, far)
    assert errors(found.T_map_sensor, TRUE)[0] < 0.06
    nearby = errors(cascade.align(SCAN, GUESS).T_map_sensor, alone.align(SCAN, GUESS).T_map_sensor)
    assert nearby[0] < 0.01
    assert cascade.score(SCAN, TRUE) == alone.score(SCAN, TRUE)


def test_a_map_of_other_levels_is_refused() -> None:
    one_level = MatcherOptions(coarse_levels=())
    with pytest.raises(ManycoreError, match=r"coarse_levels=\(2.0,\), found \(\)"):
        SerialMatcher().set_map(VoxelMap.from_points(WORLD, one_level))


@pytest.mark.parametrize(
    "angles",
    [(np.pi, 0, 0), (0, np.pi, 0.4), (0, np.pi / 2, 0), (0.3, -np.pi / 2, 0), (1.5, 1.4, -2)],
    ids=str,
)
def test_a_sensor_may_look_anywhere(angles: tuple[float, float, float]) -> None:
    mounted = pose(0, 0, 0, *angles)  # T_vehicle_sensor
    scan = (SCAN @ mounted[:3, :3]).astype(np.float32)
    level, turned = matcher().align(SCAN, GUESS), matcher().align(scan, GUESS @ mounted)
    assert turned.converged, turned.why
    distance_m, angle_deg = errors(turned.T_map_sensor, level.T_map_sensor @ mounted)
    assert distance_m < 0.02
    assert angle_deg < 0.1


@pytest.mark.parametrize("origin_m", [(4e5, 5e6, 100.0), (-3e6, -4e6, 5e6)], ids=str)
def test_a_map_may_be_far_from_the_origin(origin_m: tuple[float, float, float]) -> None:
    there = np.eye(4)
    there[:3, 3] = origin_m
    with SerialMatcher() as far_off:
        far_off.set_map(VoxelMap.from_points(WORLD + origin_m))
        found = far_off.align(SCAN, there @ GUESS)
    distance_m, angle_deg = errors(
        found.T_map_sensor, there @ matcher().align(SCAN, GUESS).T_map_sensor
    )
    assert distance_m < 0.02
    assert angle_deg < 0.1


@pytest.mark.parametrize("simd", ["portable", "avx2", "avx512"])
def test_every_kind_of_cpu_finds_the_same_place(simd: str, monkeypatch: pytest.MonkeyPatch) -> None:
    wide = matcher().align(SCAN, GUESS)
    monkeypatch.setenv("MANYCORE_NDT_SIMD", simd)
    try:
        narrow = matcher().align(SCAN, GUESS)
    except RuntimeError as error:
        pytest.skip(str(error))
    assert narrow.T_map_sensor == pytest.approx(wide.T_map_sensor, abs=1e-4)
    assert narrow.score == pytest.approx(wide.score, rel=1e-5)


@pytest.mark.parametrize(
    ("scan", "guess", "why"),
    [
        (np.zeros((0, 3)), GUESS, "no finite point"),
        (np.full((50, 3), np.nan), GUESS, "no finite point"),
        (np.full((50, 3), 3e38), GUESS, "no finite point"),
        (SCAN[:5], GUESS, "too few points"),
        (np.repeat(SCAN[:1], 1000, axis=0), GUESS, "does not constrain the pose"),
        (SCAN, GUESS * np.nan, "not finite"),
        (SCAN, np.zeros((4, 4)), "no rotation"),
        (SCAN, pose(1e300, 0, 0, 0, 0, 0), "more than 1e+09 m"),
        (SCAN, pose(1e9, 0, 0, 0, 0, 0), "no point of the scan lies in the map"),
        (SCAN + np.float32(1e6), GUESS, "no point of the scan lies in the map"),
    ],
)
def test_what_cannot_be_aligned_is_answered(scan: Any, guess: Any, why: str) -> None:
    found = matcher().align(scan, guess)
    assert not found.converged
    assert why in found.why
    assert np.isfinite(found.T_map_sensor).all()
    assert np.isfinite(found.covariance).all()


def test_points_that_are_not_finite_do_not_count() -> None:
    holes = np.concatenate([SCAN, np.full((99, 3), np.nan, np.float32)])
    holes = np.concatenate([holes, np.full((9, 3), np.inf, np.float32)])
    whole = matcher().align(SCAN, GUESS)
    assert matcher().align(holes, GUESS).T_map_sensor.tolist() == whole.T_map_sensor.tolist()


@pytest.mark.parametrize("points", [np.full((9, 3), np.nan), np.zeros((0, 3)), np.eye(3)])
def test_a_map_of_nothing_is_refused(points: Any) -> None:
    with pytest.raises(ManycoreError, match="expected voxels of 2"):
        VoxelMap.from_points(points)


def test_errors_are_the_matchers_own_beside_the_transport() -> None:
    importlib.import_module("rmw_manycore_py.native._transport")
    with pytest.raises(ManycoreError, match="no finite point"):
        VoxelMap.from_points(np.zeros((0, 3)))


def test_a_map_too_wide_to_number_is_refused() -> None:
    points = np.concatenate([WORLD, WORLD + 1e9])
    with pytest.raises(ManycoreError, match="remove far-off points"):
        VoxelMap.from_points(points)


def test_a_map_of_other_options_is_refused() -> None:
    made = SerialMatcher(MatcherOptions(search="radius"))
    with pytest.raises(ManycoreError, match="search='radius', found 'direct7'"):
        made.set_map(VoxelMap.from_points(WORLD))


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("voxel_size_m", -1.0),
        ("voxel_size_m", float("nan")),
        ("search", "kdtree"),
        ("outlier_ratio", 1.0),
        ("max_iterations", 0),
        ("step_size", "large"),
        ("trans_epsilon", 5.0),
        ("coarse_levels", (1.0,)),
        ("coarse_levels", (2.0, 3.0)),
        ("coarse_levels", (7.0, 6.0, 5.0, 4.0, 3.0, 2.0)),
    ],
)
def test_options_out_of_range_are_refused(name: str, value: Any) -> None:
    with pytest.raises(ManycoreError, match=f"{name}: expected .* found"):
        MatcherOptions(**{name: value})
