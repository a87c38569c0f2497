# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What scans leave open: along a tunnel, all over a square; and how that adds up along a drive."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from rmw_manycore_py.bench.ndt.gap_worlds import LIDAR, map_of, motorway, open_square
from rmw_manycore_py.ndt import Alignment, MatcherOptions, SerialMatcher, VoxelMap
from rmw_manycore_py.ndt.simulation.drive import poses_along
from rmw_manycore_py.ndt.simulation.street import Street, build_street
from rmw_manycore_py.ndt.trust.along import BASIN_M, MAX_PLACES, Along
from rmw_manycore_py.ndt.trust.judge import WEAK_RAD, PoseJudge
from rmw_manycore_py.ndt.trust.weak import weak_directions
from support.samples.ndt_world import pose

pytestmark = pytest.mark.unit

OPTIONS = MatcherOptions(search="radius")
X, Y = np.array([1.0, 0.0]), np.array([0.0, 1.0])
SPEED_M_S, PERIOD_S = 25.0, 0.1


def spread(x_m: float, y_m: float) -> np.ndarray:
    return np.diag([x_m**2, y_m**2])


def aligned(x: float, whole: np.ndarray, raised: np.ndarray | None = None) -> Alignment:
    """Return a good alignment at x [m] with a spread."""
    T = pose(x, 0.0, 0.0, 0.0, 0.0, 0.0)
    found = replace(Alignment.refused(T, "", OPTIONS), is_degenerate=False, converged=True)
    found = replace(found, nearest_voxel_likelihood=3.0, share_in_map=1.0)
    return replace(found, xy_spread_m2=whole, raised_spread_m2=raised)


@pytest.mark.parametrize(
    ("whole", "raised", "expected"),
    [
        (spread(0.4, 0.1), None, None),
        (spread(0.6, 0.1), None, (X, False)),
        (spread(0.4, 0.1), spread(0.45, 0.2), None),  # enough stands above the ground
        (spread(0.7, 0.1), spread(1.0, 0.2), (X, False)),
        (spread(0.4, 0.3), spread(0.5, 0.9), (Y, False)),
        (spread(0.4, 0.3), spread(1.0, 0.9), (X, True)),
        (spread(0.3, 0.4), 1e4 * np.eye(2), (Y, True)),
    ],
)
def test_what_stands_above_the_ground_has_to_constrain_the_position(whole, raised, expected):
    found = weak_directions(aligned(0.0, whole, raised))
    if expected is None:
        assert found is None
        return
    assert found is not None
    assert found.is_all == expected[1]
    if not found.is_all:
        assert abs(found.axis @ expected[0]) == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("world", "is_weak"),
    [
        (build_street(80.0, np.random.default_rng(1)), False),
        (motorway(120.0, 1), True),
        (open_square(3), True),
    ],
)
def test_scans_of_squares_and_motorways_are_weak(world: Street, is_weak: bool):
    """Though the score of the whole scan has a sharp maximum: that of the ground's voxels."""
    matcher = SerialMatcher(OPTIONS)
    matcher.set_map(VoxelMap.from_points(map_of(world, 80.0), OPTIONS))
    weak = []
    for index, T in enumerate(poses_along(np.arange(20.0, 60.0, 4.0))):
        scan = LIDAR.scan(world, T, np.random.default_rng((5, index)))
        found = matcher.align_once(scan, T)
        assert weak_directions(found) is None
        weak.append(weak_directions(matcher.raised(found, scan)) is not None)
    assert np.mean(weak) >= 0.8 if is_weak else not any(weak)


def driven() -> tuple[PoseJudge, float, float]:
    """Return a judge that has seen a fast drive along x; stamp and x of the next scan."""
    judge = PoseJudge()
    judge.level.map_changed(3.0)
    stamp_s = x = 0.0
    for _ in range(20):
        judge.believe(stamp_s, aligned(x, spread(0.2, 0.1)), pose(x, 0.0, 0.0, 0.0, 0.0, 0.0))
        stamp_s, x = stamp_s + PERIOD_S, x + SPEED_M_S * PERIOD_S
    return judge, stamp_s, x


def test_another_weak_direction_adds_to_the_first_one():
    judge, stamp_s, x = driven()
    along = aligned(x, spread(0.7, 0.1))
    for _ in range(30):
        guess = pose(x, 0.0, 0.0, 0.0, 0.0, 0.0)
        judge.believe(stamp_s, replace(along, T_map_sensor=guess), guess)
        stamp_s, x = stamp_s + PERIOD_S, x + SPEED_M_S * PERIOD_S
    before = judge.judge(stamp_s, replace(along, T_map_sensor=guess), guess).along
    guess = pose(x, 0.0, 0.0, 0.0, 0.0, 0.0)
    across = judge.judge(stamp_s, aligned(x, spread(0.1, 0.7)), guess)
    assert before is not None
    assert across.along is not None
    covariance = across.covariance(1e-4 * np.eye(6))
    assert covariance[0, 0] > 0.8 * before.deviation_m**2
    assert covariance[1, 1] > 2.0**2
    nothing = judge.judge(stamp_s, aligned(x, spread(0.4, 0.4), 1e4 * np.eye(2)), guess)
    assert nothing.corrected(pose(x + 1.0, 2.0, 0.0, 0.0, 0.0, 0.0)) == pytest.approx(guess)
    assert nothing.covariance(1e-4 * np.eye(6))[5, 5] == WEAK_RAD**2  # nothing tells the yaw
    assert across.covariance(1e-4 * np.eye(6))[5, 5] == 1e-4


def test_a_jump_of_guesses_in_a_gap_is_in_doubt_however_fast_the_vehicle_was():
    judge, stamp_s, x = driven()
    for jump_m, is_sure in ((1.0, True), (12.0, False)):
        at = x + 3.0 * SPEED_M_S + jump_m
        there = aligned(at, spread(0.2, 0.1))
        verdict = judge.judge(stamp_s + 3.0, there, there.T_map_sensor)
        assert verdict.is_believed
        assert verdict.is_sure == is_sure


def test_two_uncertainties_make_one():
    joined = Along(X, 1.0).joined(Along(Y, 5.0, across_m=0.5))
    np.testing.assert_array_equal(joined.axis, Y)
    assert (joined.deviation_m, joined.across_m) == (5.0, 1.0)
    np.testing.assert_allclose(joined.covariance_m2, np.diag([1.0, 25.0]))
    origin, away = np.eye(4), pose(3.0, 30.0, 0.0, 0.0, 0.0, 0.0)
    np.testing.assert_allclose(joined.nearest(origin, away)[:2, 3], (2.0, 10.0))
    np.testing.assert_allclose(joined.beyond_m(np.array([3.0, 30.0]), 3.0), (0.0, 15.0))


def test_places_are_tried_along_and_across():
    narrow, wide = Along(X, 8.0).places(np.eye(4)), Along(X, 8.0, 3.0).places(np.eye(4))
    assert {place[1, 3] for place in narrow} == {0.0}
    assert {place[1, 3] for place in wide} == {-6.0, -3.0, 0.0, 3.0, 6.0}
    assert len(Along(X, 1e4, 1e4).places(np.eye(4))) <= MAX_PLACES
    assert Along(X, 1.0, 1.1 * BASIN_M).is_open
