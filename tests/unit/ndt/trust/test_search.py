# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Search of a pose in a separate process, and the steps of a recovery."""

from __future__ import annotations

import os
import signal
from collections import Counter
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from rmw_manycore_py.bench.ndt.trust_worlds import Drive, simulated
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.ndt import MatcherOptions, SerialMatcher, VoxelMap
from rmw_manycore_py.ndt.geometry import poses
from rmw_manycore_py.ndt.geometry.arrays import scan_points
from rmw_manycore_py.ndt.matching.alignment import Alignment
from rmw_manycore_py.ndt.trust import recovery as recovery_module
from rmw_manycore_py.ndt.trust.judge import PoseJudge
from rmw_manycore_py.ndt.trust.recovery import Recovery, Step
from rmw_manycore_py.ndt.trust.score_level import ScoreLevel
from rmw_manycore_py.ndt.trust.search import Found, Region, search, search_steps
from support import wait_until
from support.samples.ndt_world import errors, pose, scan_at, street

pytestmark = pytest.mark.unit

OPTIONS = MatcherOptions()
TRUTH = pose(8.0, 1.0, 1.8, 0.0, 0.0, 0.3)  # near an end of the street: a unique place


@pytest.fixture(scope="module")
def world() -> tuple[np.ndarray, VoxelMap]:
    """Return a street with a tower that breaks its periodicity, and its map."""
    rng = np.random.default_rng(2)
    y, z = rng.uniform(4.0, 7.0, 4000), rng.uniform(0.0, 9.0, 4000)
    tower = np.stack([rng.normal(12.0, 0.02, 4000), y, z], axis=1)
    x = rng.uniform(12.0, 16.0, 4000)
    side = np.stack([x, rng.normal(4.0, 0.02, 4000), z], axis=1)
    points = np.concatenate([street(spacing_m=0.3), tower, side])
    return points, VoxelMap.from_points(points, OPTIONS)


@pytest.fixture
def recovery(world: tuple[np.ndarray, VoxelMap]) -> Iterator[Recovery]:
    recovery = Recovery(OPTIONS, after_scans=2, radius_m=10.0)
    recovery.map_changed(world[1])
    yield recovery
    recovery.close()


def judge_of(voxel_map: VoxelMap) -> PoseJudge:
    judge = PoseJudge()
    judge.level.map_changed(voxel_map.own_score)
    return judge


def searched(recovery: Recovery, judge: PoseJudge, scan: np.ndarray, at: np.ndarray) -> bool:
    """Refuse scans until a search is over; return whether it found a pose."""
    for _ in range(2):
        recovery.refused(1.0, scan, at, at)
    assert recovery.step in (Step.AROUND, Step.GLOBALLY)
    found: list[bool] = []

    def is_over() -> bool:
        before = recovery.note
        found.append(recovery.take(judge))
        return found[-1] or recovery.note != before

    wait_until(is_over, "the search is over")
    return found[-1]


def test_a_place_near_by_is_found_around_the_last_pose(world, recovery):
    points, voxel_map = world
    judge = judge_of(voxel_map)
    at = TRUTH.copy()
    at[:2, 3] += (-2.5, 1.5)
    assert searched(recovery, judge, scan_at(points, TRUTH), at)
    assert recovery.step is Step.FOUND
    distance_m, angle_deg = errors(judge.motion.last.T, TRUTH)
    assert distance_m < 0.1
    assert angle_deg < 1.0
    recovery.believed()
    assert recovery.step is Step.TRACKING


def test_farther_off_and_turned_it_is_found_globally(world, recovery):
    points, voxel_map = world
    judge = judge_of(voxel_map)
    at = TRUTH @ pose(8.0, 1.0, 0.0, 0.0, 0.0, 3.0)
    assert not searched(recovery, judge, scan_at(points, TRUTH), at)
    assert "searching around" in recovery.note
    assert judge.motion.last is None
    assert searched(recovery, judge, scan_at(points, TRUTH), at)
    assert errors(judge.motion.last.T, TRUTH)[0] < 0.1


def test_for_a_first_pose_it_is_searched_with_the_first_scan(world, recovery):
    points, voxel_map = world
    judge, scan = judge_of(voxel_map), scan_at(points, TRUTH)
    at = TRUTH @ pose(8.0, 1.0, 0.0, 0.0, 0.0, 3.0)
    recovery.refused(1.0, scan, at, at, is_first=True)
    assert recovery.step is Step.GLOBALLY
    wait_until(lambda: recovery.take(judge), "the search has found it")
    assert errors(judge.motion.last.T, TRUTH)[0] < 0.1


def test_searches_for_a_first_pose_become_rare(world, recovery):
    """Where nothing is found, as outside of the map."""
    points, voxel_map = world
    judge, at = judge_of(voxel_map), pose(500.0, 0.0, 1.8, 0.0, 0.0, 0.0)
    steps = []
    for stamp_s in range(6):
        recovery.step = Step.TRACKING
        recovery.refused(float(stamp_s), scan_at(points, TRUTH), at, at, is_first=True)
        steps.append(recovery.step)
        if recovery.step is not Step.TRACKING:
            wait_until(lambda: "fits nowhere" in recovery.note or recovery.take(judge), "its end")
            recovery.note = ""
    nothing = Step.TRACKING
    assert steps == [Step.GLOBALLY, Step.AROUND, nothing, Step.GLOBALLY, nothing, Step.GLOBALLY]


def test_where_the_street_repeats_no_place_stands_out(recovery):
    points = street(spacing_m=0.3)
    voxel_map = VoxelMap.from_points(points, OPTIONS)
    recovery.map_changed(voxel_map)
    judge = judge_of(voxel_map)
    middle = pose(38.0, 0.0, 1.8, 0.0, 0.0, 0.1)
    scan = scan_at(points, middle, reach_m=18.0)
    away = middle.copy()
    away[0, 3] += 8.0  # half a period
    searched(recovery, judge, scan, away)
    assert not searched(recovery, judge, scan, away)
    assert "equally well" in recovery.note
    assert judge.motion.last is None


@pytest.fixture(scope="module")
def drives() -> tuple[Drive, Drive]:
    return simulated()["street 1"](), simulated()["street 2"]()


@pytest.fixture(scope="module")
def matcher(drives) -> SerialMatcher:
    matcher = SerialMatcher(drives[0].options)
    matcher.set_map(VoxelMap.from_points(drives[0].map_points, drives[0].options))
    return matcher


def lost_in(matcher: SerialMatcher, scan: np.ndarray) -> tuple[Found, str]:
    """Search the whole map; return also why the best place is not accepted."""
    region = Region(np.eye(4), np.inf, any_yaw=True)
    found = search(matcher, scan_points(scan), region)
    return found, found.why_unclear(judge_of(matcher.map).level, region)


@pytest.mark.parametrize(("index", "ahead_m"), [(3, 30.0), (5, -30.0), (61, 30.0)])
def test_a_search_that_does_not_reach_the_scan_finds_nothing(drives, matcher, index, ahead_m):
    """Not even where one place stands out from the others there."""
    centre = drives[0].poses[index] @ pose(ahead_m, 0.0, 0.0, 0.0, 0.0, 0.0)
    region = Region(centre, 20.0, any_yaw=True)
    found = search(matcher, scan_points(drives[0].scan(index)), region)
    assert "explained score" in found.why_unclear(judge_of(matcher.map).level, region)


def test_a_scan_is_found_without_a_guess(drives, matcher):
    for index in (10, 40, 70):
        found, unclear = lost_in(matcher, drives[0].scan(index))
        assert not unclear
        distance_m, angle_deg = errors(found.places[0].T_map_sensor, drives[0].poses[index])
        assert distance_m < 0.2
        assert angle_deg < 1.0


def test_a_scan_from_a_place_that_the_map_lacks_is_refused(drives, matcher):
    for index in (10, 40, 70):
        assert lost_in(matcher, drives[1].scan(index))[1]


def test_a_scan_that_fits_only_when_it_is_tilted_is_refused(drives, matcher):
    """Gravity is known: a wall is no ground."""
    lying = drives[0].scan(40)[:, [2, 0, 1]]
    assert lost_in(matcher, lying)[1]


def test_a_scan_of_the_ground_alone_fits_nowhere(matcher):
    x, y = np.meshgrid(np.arange(-20.0, 20.0), np.arange(-20.0, 20.0))
    ground = np.stack([x.ravel(), y.ravel(), np.full(x.size, -1.9)], axis=1)
    assert lost_in(matcher, ground)[1] == "the scan fits nowhere"
    assert lost_in(matcher, np.full((10, 3), np.nan))[1] == "the scan fits nowhere"


def found_at(*places: tuple[float, float]) -> Found:
    """Return places at some x [m], and their explained scores."""
    base = replace(Alignment.refused(np.eye(4), "", OPTIONS), is_degenerate=False)
    return Found(
        tuple(
            replace(base, T_map_sensor=pose(x, 0.0, 0.0, 0.0, 0.0, 0.0), explained_score=score)
            for x, score in places
        )
    )


@pytest.mark.parametrize(
    ("wide", "near", "why"),
    [
        (((0.0, 0.86), (9.0, 0.5)), ((0.2, 0.86),), ""),
        (((0.0, 0.86), (9.0, 0.83)), ((0.2, 0.86),), "below"),  # the first does not stand out
        (((0.0, 0.86), (9.0, 0.5)), ((0.2, 0.82),), "below"),
        (((9.0, 0.7), (0.0, 0.5)), ((0.0, 0.86),), "below"),  # the first led elsewhere
        (((9.0, 0.7), (0.0, 0.5)), ((0.0, 0.95),), "larger region"),
        (((0.0, 0.86), (9.0, 0.5)), ((0.2, 0.86), (4.0, 0.85)), "equally well"),
    ],
)
def test_a_second_search_confirms_a_first_pose(wide, near, why):
    level = ScoreLevel()
    level.map_changed(1.0)
    everywhere, around = (
        Region(np.eye(4), 20.0, any_yaw=True),
        Region(np.eye(4), 5.0, any_yaw=False),
    )
    assert "below" in found_at(*wide).why_unclear(level, everywhere)
    unclear = found_at(*near).why_unclear(level, around, found_at(*wide), is_first=True)
    assert why in unclear
    assert bool(why) == bool(unclear)


def test_around_a_first_guess_a_search_only_confirms(world, recovery):
    points, voxel_map = world
    judge, scan = judge_of(voxel_map), scan_at(points, TRUTH)
    recovery.refused(1.0, scan, TRUTH, TRUTH, is_first=True)
    wait_until(lambda: recovery.take(judge), "the wide search has found it")
    recovery.step, recovery._searches = Step.TRACKING, 1
    then = recovery_module._Scan(1.0, scan, TRUTH)
    recovery._before = found_at((30.0, 1.0)), then  # as if that had led elsewhere
    recovery.refused(2.0, scan, TRUTH, TRUTH, is_first=True)
    assert recovery.step is Step.AROUND
    wait_until(lambda: recovery.take(judge) or "searching" in recovery.note, "its end")
    assert "in a larger region it is not the best" in recovery.note


def test_a_first_pose_is_confirmed_while_the_vehicle_drives():
    motion = pose(3.0, 0.0, 0.0, 0.0, 0.0, 0.2)
    before, now = found_at((5.0, 0.86), (20.0, 0.5)), found_at((8.0, 0.86)).places[0]
    now = replace(now, T_map_sensor=now.T_map_sensor @ pose(0.0, 0.0, 0.0, 0.0, 0.0, 0.2))
    assert before.moved(motion).leads_to(now)
    assert not before.leads_to(now)


def shared_names() -> Counter[str]:
    """Return the names of this process's shared memory without files."""
    lines = Path("/proc/self/maps").read_text().splitlines()
    return Counter(line.split("/memfd:")[1].split()[0] for line in lines if "/memfd:" in line)


def test_room_for_a_search_is_made_before_its_memory_is_used(drives, matcher):
    asked: list[tuple[int, Counter[str]]] = []

    def make_room(size_bytes: int) -> None:
        asked.append((size_bytes, shared_names()))
        if len(asked) == 2:
            raise ManycoreError("no room")

    region = Region(np.eye(4), np.inf, any_yaw=True)
    scan = scan_points(drives[0].scan(40))
    with pytest.raises(ManycoreError, match="no room"):
        next(search_steps(matcher, scan, region, make_room))
    (map_bytes, before), (all_bytes, between) = asked
    assert all_bytes > map_bytes > 0
    assert between - before == {"manycore-ndt-search-map": 1}


def test_places_of_a_known_heading_are_found_beside_better_ones(drives, matcher):
    """From the other way round the scan fits worse, but somewhere."""
    truth = drives[0].poses[40]
    for turn_rad in (0.0, np.pi):
        centre = truth @ pose(0.0, 0.0, 0.0, 0.0, 0.0, turn_rad)
        region = Region(centre, 10.0, any_yaw=False)
        places = search(matcher, scan_points(drives[0].scan(40)), region).places
        assert places
        for place in places:  # aligned from within 45 degrees
            assert poses.angle_rad(place.T_map_sensor, centre) < np.radians(60.0)


def test_a_killed_search_is_reported_and_repeated(world, recovery):
    points, voxel_map = world
    scan, judge = scan_at(points, TRUTH), judge_of(voxel_map)
    assert searched(recovery, judge, scan, TRUTH)
    helper = recovery._search._helper
    os.kill(helper.pid, signal.SIGSTOP)  # so that it is killed during the call
    for _ in range(2):
        recovery.refused(2.0, scan, TRUTH, TRUTH)
    wait_until(helper._turn.locked, "the helper is called")
    os.kill(helper.pid, signal.SIGKILL)
    wait_until(lambda: not recovery.take(judge) and "ended" in recovery.note, "it is told")
    assert searched(recovery, judge, scan, TRUTH) or searched(recovery, judge, scan, TRUTH)
