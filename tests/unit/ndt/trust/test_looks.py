# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A refused scan is aligned again, but not too often: a newer one waits."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import product
from typing import Any

import numpy as np
import pytest

from rmw_manycore_py.bench.ndt import trust_variants
from rmw_manycore_py.bench.ndt.gap_worlds import LIDAR, open_square
from rmw_manycore_py.bench.ndt.trust_worlds import Drive, simulated
from rmw_manycore_py.ndt import Alignment, MatcherOptions, SerialMatcher, VoxelMap
from rmw_manycore_py.ndt.geometry import poses
from rmw_manycore_py.ndt.geometry.arrays import Pose, scan_points
from rmw_manycore_py.ndt.simulation.street import Street
from rmw_manycore_py.ndt.trust.judge import PoseJudge, Verdict
from rmw_manycore_py.ndt.trust.looks import VAIN_SCANS, Looks, ScanAt

pytestmark = pytest.mark.unit

OPTIONS = MatcherOptions(search="radius")
FIRST = 5  # scan


@pytest.fixture(scope="module")
def drive() -> Drive:
    return simulated()["street 1"]()


@pytest.fixture(scope="module")
def voxel_map(drive) -> VoxelMap:
    return VoxelMap.from_points(drive.map_points, OPTIONS)


class WatchedMatcher(SerialMatcher):
    """Counts the alignments to the finest level alone."""

    closer = 0

    def closer_looks(self, *args: Any, **options: Any) -> Iterator[Alignment]:
        """Align as usual."""
        for found in super().closer_looks(*args, **options):
            self.closer += 1
            yield found


class Counted:
    """Looks at scans of drives in a map; counts alignments.

    :ivar verdict: of the last scan.
    """

    verdict: Verdict

    def __init__(self, voxel_map: VoxelMap, options: MatcherOptions = OPTIONS) -> None:
        self._judge = PoseJudge()
        self._judge.level.map_changed(voxel_map.own_score)
        self._aligned: list[int] = []
        self.matcher = WatchedMatcher(options)
        self.matcher.set_map(voxel_map)
        self.matcher.on_aligned = self._aligned.append
        self.looks = Looks(self.matcher, self._judge)

    def look(
        self, drive: Drive, index: int, guess: Pose | None = None, *, is_searching: bool = False
    ) -> int:
        """Return the number of alignments; continue from the result if it is believed."""
        before, truth = len(self._aligned), drive.poses[index]
        stamp_s, points = float(drive.stamps_s[index]), scan_points(drive.scan(index))
        scan = ScanAt(stamp_s, points, truth if guess is None else guess, None)
        alignment, self.verdict = self.looks.look(scan, is_searching=is_searching)
        if self.is_believed:
            assert poses.distance_m(alignment.T_map_sensor, truth) < 0.2
            self._judge.believe(stamp_s, alignment, scan.guess)
            self.looks.hope()
        return len(self._aligned) - before

    @property
    def is_believed(self) -> bool:
        """Return whether the last scan's pose was believed."""
        return self.verdict.is_believed


@pytest.fixture
def counted(drive, voxel_map) -> Counted:
    """Return what has seen scans up to FIRST."""
    found = Counted(voxel_map)
    for index in range(FIRST - 5, FIRST):
        found.look(drive, index)
    return found


def test_scans_that_fit_are_aligned_once(counted, drive):
    assert [counted.look(drive, FIRST + index) for index in range(3)] == [1, 1, 1]


def test_scans_that_fit_nowhere_are_soon_aligned_no_more_than_before(counted):
    elsewhere = trust_variants.with_vehicles(simulated()["tunnel"]())
    numbers = [counted.look(elsewhere, FIRST + index) for index in range(15)]
    assert not counted.is_believed
    assert max(numbers[:VAIN_SCANS]) in range(8, 12)
    assert max(numbers[VAIN_SCANS:]) <= 4
    counted.looks.hope()
    assert counted.look(elsewhere, FIRST + 15, is_searching=True) <= 4


def test_where_vehicles_hide_much_the_finest_level_alone_finds_the_pose(voxel_map, drive):
    crowded, counted = trust_variants.with_vehicles(drive, 0.5), Counted(voxel_map)
    believed = []
    for index in range(FIRST, FIRST + 30):
        alignments = counted.look(crowded, index)
        believed += [alignments] if counted.is_believed else []
    assert len(believed) >= 29
    # From guess and motion, then without vehicles, and twice without what is foreign.
    assert 5 in believed
    assert counted.matcher.closer > 0


@pytest.mark.parametrize(
    ("index", "off_m", "looks"),
    [
        (61, (1.0, 0.0, 0.0), 1),  # half of the scan is where the map is empty: without that half
        (67, (0.5, 0.0, 0.0), 2),  # that leads astray, and the guess itself home
    ],
)
def test_where_half_of_the_map_is_missing_the_finest_level_finds_the_pose(index, off_m, looks):
    half = trust_variants.CHANGES["40 % on vehicles, no map on the left"]
    drive = half(simulated()["street 1"]())
    counted = Counted(VoxelMap.from_points(drive.map_points, OPTIONS))
    counted.look(drive, index, drive.poses[index] @ poses.from_xyz_rpy(off_m))
    assert counted.is_believed
    assert counted.matcher.closer == looks


def car_park(cars: int) -> Street:
    """Return pillars every 8 m below a ceiling, a stairwell, and some of the cars."""
    generator = np.random.default_rng(cars)
    boxes = [[0.0, -0.4, 0.0, 60.0, 0.0, 2.9], [0.0, 40.0, 0.0, 60.0, 40.4, 2.9]]
    boxes += [[-0.4, 0.0, 0.0, 0.0, 40.0, 2.9], [60.0, 0.0, 0.0, 60.4, 40.0, 2.9]]
    boxes += [[0.0, 0.0, 2.9, 60.0, 40.0, 3.1], [37.0, 28.0, 0.0, 43.0, 32.0, 2.9]]
    for x, y in product(range(8, 60, 8), range(8, 40, 8)):
        boxes.append([x - 0.25, y - 0.25, 0.0, x + 0.25, y + 0.25, 2.9])
    for x, y in product(np.arange(1.5, 59.0, 2.6), (0.4, 16.4, 21.0, 35.0)):
        if generator.random() < 0.6:
            boxes.append([x - 0.9, y, 0.25, x + 0.9, y + 4.4, generator.uniform(1.4, 1.8)])
    lower, upper = np.hsplit(np.array(boxes), 2)
    return Street(lower, upper, np.zeros((0, 2)), np.zeros(0), np.zeros(0))


def test_a_first_pose_that_fits_nowhere_is_soon_looked_around_no_more(voxel_map):
    hidden = trust_variants.with_vehicles(simulated()["tunnel"]())
    searching, counted = Counted(voxel_map), Counted(voxel_map)
    assert searching.look(hidden, FIRST, is_searching=True) == 1
    numbers = [counted.look(hidden, FIRST + index) for index in range(VAIN_SCANS + 2)]
    assert not counted.is_believed
    assert min(numbers[:VAIN_SCANS]) > 5
    assert numbers[VAIN_SCANS:] == [1, 1]


@pytest.mark.parametrize("voxel_size_m", [1.0, 2.0])
def test_among_equal_pillars_and_other_cars_than_mapped_a_first_pose_is_right(voxel_size_m):
    """Wrong places nearer to the guess are explained, too: by cars."""
    options = MatcherOptions(search="radius", voxel_size_m=voxel_size_m)
    path = [poses.from_xyz_rpy((x, 12.0, 1.9)) for x in np.arange(6.0, 54.0, 2.0)]
    surveyed, now = car_park(1), car_park(2)
    scans = [
        LIDAR.scan(surveyed, T, np.random.default_rng(3)) @ T[:3, :3].T + T[:3, 3] for T in path
    ]
    counted = Counted(VoxelMap.from_points(np.concatenate(scans), options), options)
    found = []
    for index, T in enumerate(path[::2]):
        a = 2.0 * index
        guess = T @ poses.from_xyz_rpy((4.0 * np.cos(a), 4.0 * np.sin(a), 0.0))
        scan = LIDAR.scan(now, T, np.random.default_rng((4, index)))
        alignment, verdict = counted.looks.look(ScanAt(0.0, scan, guess, None), is_searching=False)
        found.append(verdict.is_believed and poses.distance_m(alignment.T_map_sensor, T) < 0.2)
    assert np.mean(found) >= 0.9


def test_on_a_square_no_place_is_better_than_the_guess():
    """Vehicles would explain places 6 to 10 m away, though the ground is all that fits there."""
    square, path = open_square(3), [poses.from_xyz_rpy((x, 2.0, 1.9)) for x in range(10, 110, 3)]
    scans = [LIDAR.scan(square, T, np.random.default_rng(3)) @ T[:3, :3].T + T[:3, 3] for T in path]
    counted = Counted(VoxelMap.from_points(np.concatenate(scans), OPTIONS))
    for index, T in enumerate(path[::2]):
        seen = LIDAR.scan(square, T, np.random.default_rng((4, index)))
        hidden = trust_variants.hidden_by_vehicles(seen, 0.2, np.random.default_rng((5, index)))
        guess = T @ poses.from_xyz_rpy((0.5 * np.cos(index), 0.5 * np.sin(index), 0.0))
        scan = ScanAt(0.0, scan_points(hidden), guess, None)
        alignment, verdict = counted.looks.look(scan, is_searching=False)
        assert not verdict.is_believed or poses.distance_m(alignment.T_map_sensor, T) < 1.0
        counted.looks.hope()


def test_motion_that_refuses_a_good_score_leads_back_to_where_it_leads(counted, drive):
    assert counted.look(drive, FIRST, drive.poses[FIRST + 20]) <= 3
    assert counted.is_believed


def test_a_pose_that_motion_alone_refuses_is_not_looked_at_more_closely(counted, drive):
    late_s = drive.stamps_s[FIRST + 20] - drive.stamps_s[FIRST]
    jumped = replace(drive, stamps_s=drive.stamps_s - late_s)
    assert counted.look(jumped, FIRST + 20) > 1
    assert not counted.is_believed
    assert not counted.verdict.is_score_low
    assert counted.matcher.closer == 0
