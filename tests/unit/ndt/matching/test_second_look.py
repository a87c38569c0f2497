# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A second look finds home from where the first one does not, and leads no right result astray."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.native import _ndt
from rmw_manycore_py.ndt import Alignment, MatcherOptions, SerialMatcher, VoxelMap
from rmw_manycore_py.ndt.geometry.arrays import Pose, scan_points
from rmw_manycore_py.ndt.matching.kernel_options import match_options
from rmw_manycore_py.ndt.matching.second_look import CONVINCING_SHARE, best_of_second_look
from support.samples.ndt_world import errors, pose, scan_at, street

pytestmark = pytest.mark.unit

WORLD = street()
TRUE = pose(40, 0.5, 1.8, 0.01, -0.02, 0.3)
NEAR = pose(40.4, 0.2, 1.9, 0, 0, 0.34)
FAR = TRUE @ pose(6, 3, 0, 0, 0, 0.3)
SCAN = scan_at(WORLD, TRUE)
OPTIONS = MatcherOptions()
MAP = VoxelMap.from_points(WORLD, OPTIONS)


@pytest.fixture
def matcher() -> SerialMatcher:
    made = SerialMatcher(OPTIONS)
    made.set_map(MAP)
    return made


def numbers(found: Alignment) -> tuple[object, ...]:
    return found.T_map_sensor.tolist(), found.iterations, found.score, found.looks


def test_a_second_look_finds_home_from_farther_off(matcher: SerialMatcher) -> None:
    assert errors(matcher.align_once(SCAN, FAR).T_map_sensor, TRUE)[0] > 0.5
    found = matcher.align(SCAN, FAR)
    assert errors(found.T_map_sensor, TRUE)[0] < 0.06
    assert found.looks > 1
    only_near = SerialMatcher(replace(OPTIONS, wide_levels=()))
    only_near.set_map(VoxelMap.from_points(WORLD, only_near.options))
    near = only_near.align(SCAN, FAR)
    assert near.looks == 3  # two of them closer
    assert errors(near.T_map_sensor, TRUE)[0] > 0.5


def test_a_convincing_result_is_not_looked_at_again(matcher: SerialMatcher) -> None:
    found = matcher.align(SCAN, NEAR)
    assert found.looks == 1
    assert numbers(found) == numbers(matcher.align_once(SCAN, NEAR))


def test_an_unconvincing_right_result_is_not_led_astray(matcher: SerialMatcher) -> None:
    """Half of the points are of what the map does not have: no place convinces."""
    rng = np.random.default_rng(5)
    traffic = rng.uniform((-20, -6, -1.5), (20, 6, 3), (len(SCAN), 3)).astype(np.float32)
    scan = np.concatenate([SCAN, traffic])
    found = matcher.align(scan, NEAR)
    assert found.fit < CONVINCING_SHARE * MAP.own_score
    assert found.looks > 1
    assert errors(found.T_map_sensor, TRUE)[0] < 0.2


@pytest.mark.parametrize(
    ("fits", "expected", "looks"),
    [
        ((0.5, 0.95, 0.99), 0.95, 2),  # the first that convinces
        ((0.5, 0.4, 0.7, 0.6, 0.3, 0.2), 0.7, 6),  # else the best
        ((0.5, 0.4, 0.3, 0.2, 0.1, 0.0), 0.5, 6),  # the first result, too
        ((0.5, -0.99, 0.95), 0.95, 3),  # below 0: degenerate, which does not count
    ],
    ids=str,
)
def test_the_first_that_convinces_else_the_best(
    matcher: SerialMatcher, fits: tuple[float, ...], expected: float, looks: int
) -> None:
    real = replace(matcher.align_once(SCAN, NEAR), share_in_map=1.0)

    def fitting(fit: float) -> Alignment:
        return replace(real, nearest_voxel_likelihood=abs(fit), is_degenerate=fit < 0)

    first, *more = (fitting(fit) for fit in fits)
    found = best_of_second_look(first, NEAR, lambda *_: more.pop(0), lambda one: one.fit > 0.9)
    assert (found.fit, found.looks) == (expected, looks)


def test_a_second_look_starts_from_the_guess_and_on_its_four_sides(matcher: SerialMatcher) -> None:
    first = replace(matcher.align_once(SCAN, NEAR), share_in_map=0.0)
    guess = pose(40, 1, 2, 0, 0, np.pi / 2)  # ahead is +y, left is -x
    starts = []

    def align_widely(start: Pose, _: float) -> Alignment:
        starts.append(start[:3, 3].round(6).tolist())
        return first

    best_of_second_look(first, guess, align_widely, lambda _: False)
    expected = [[40, 1, 2], [40, 5, 2], [40, -3, 2], [36, 1, 2], [44, 1, 2]]
    assert starts == expected


def test_starts_are_followed_where_they_surpass_all_before(matcher: SerialMatcher) -> None:
    real = matcher.align_once(SCAN, NEAR)
    scores = [5.0, 3.0, 7.0, 6.0, 8.0]
    first, *more = (replace(real, first=replace(real.first, score=score)) for score in scores)
    more.append(first)
    asked = []

    def align_widely(_: Pose, surpassed: float) -> Alignment:
        asked.append(surpassed)
        return more.pop(0)

    best_of_second_look(first, NEAR, align_widely, lambda _: False)
    assert asked == [5.0, 5.0, 7.0, 7.0, 8.0]


def test_what_a_start_leads_to_is_aligned_no_further_where_another_was_better() -> None:
    matcher = _ndt.SerialMatcher(match_options(OPTIONS))
    scan = scan_points(SCAN)
    followed = matcher.align(MAP.levels, scan, NEAR, None, 1, 1)
    at_start = followed.first.score
    alike = matcher.align(MAP.levels, scan, NEAR, None, 1, 1, np.nextafter(at_start, 0.0))
    assert (alike.outcome, alike.pose.tolist()) == ("converged", followed.pose.tolist())
    surpassed = matcher.align(MAP.levels, scan, NEAR, None, 1, 1, at_start)
    assert (surpassed.outcome, surpassed.first.score) == ("surpassed", at_start)
    assert 0 < surpassed.iterations < followed.iterations
    assert Alignment.of(surpassed, OPTIONS).is_degenerate


def test_a_result_of_few_points_that_fits_too_little_is_not_refined() -> None:
    matcher = _ndt.SerialMatcher(match_options(OPTIONS))
    scan = scan_points(np.tile(SCAN, (-(-10_000 // len(SCAN)), 1)))

    def aligned(min_fit: float) -> _ndt.NewtonResult:
        return matcher.align(MAP.levels, scan, NEAR, None, 1, 1, -np.inf, min_fit)

    finished = aligned(-np.inf)
    assert finished.at.scan_points == len(scan)
    few = aligned(1e9)
    assert few.at.scan_points < len(scan) / 2
    assert (few.outcome, few.first.score) == ("unfinished", finished.first.score)
    fit = few.at.nearest / few.at.scan_points
    assert aligned(fit + 1e-9).outcome == "unfinished"
    alike = aligned(fit - 1e-9)
    assert (alike.outcome, alike.pose.tolist()) == ("converged", finished.pose.tolist())


@pytest.mark.parametrize("wide_levels", [(), OPTIONS.wide_levels], ids=["closer", "search"])
def test_what_is_found_is_refined_though_nothing_convinces(wide_levels: tuple[float, ...]) -> None:
    """Half of the points are of what the map does not have."""
    matcher = SerialMatcher(replace(OPTIONS, wide_levels=wide_levels))
    matcher.set_map(VoxelMap.from_points(WORLD, matcher.options))
    rng = np.random.default_rng(6)
    traffic = rng.uniform((-20, -6, -1.5), (20, 6, 3), (len(SCAN), 3)).astype(np.float32)
    scan = np.concatenate([np.tile(SCAN, (4, 1)), np.tile(traffic, (4, 1))])
    assert len(scan) > 8192  # few points approach the pose
    found = matcher.align(scan, NEAR)
    assert found.looks > 1
    assert not found.is_unfinished
    assert found.score == pytest.approx(matcher.score(scan, found.T_map_sensor).score)
    assert len(found.path) == found.iterations + 1


def test_wide_levels_come_first_in_a_second_look(matcher: SerialMatcher) -> None:
    assert errors(matcher.align_once(SCAN, FAR).T_map_sensor, TRUE)[0] > 0.5
    assert errors(matcher.align_once(SCAN, FAR, is_wide=True).T_map_sensor, TRUE)[0] < 0.06


def test_what_cannot_be_aligned_is_not_looked_at_again(matcher: SerialMatcher) -> None:
    for scan, guess in ((SCAN[:0], NEAR), (SCAN[:5], NEAR), (SCAN, NEAR * np.nan)):
        found = matcher.align(scan, guess)
        assert found.is_refused
        assert found.looks == 1


def test_levels_of_a_second_look() -> None:
    """They are coarser than the others; without coarse levels, as in PCL, there are none."""
    assert OPTIONS.coarser_levels == (4.0, 2.0)
    assert replace(OPTIONS, coarse_levels=()).coarser_levels == ()
    assert replace(OPTIONS, coarse_levels=(4.0, 2.0)).second_look_levels == ()
    assert len(MAP.levels) == 4
    assert (MAP.first, MAP.scored, MAP.polishing) == (1, 2, 1)
    with pytest.raises(ManycoreError, match="coarse_levels: expected at most 5 with wide_levels"):
        replace(OPTIONS, wide_levels=(64.0, 32.0, 16.0, 8.0, 4.0))
