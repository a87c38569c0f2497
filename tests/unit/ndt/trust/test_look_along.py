# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""After a gap, places along the way are tried; what stands out is believed."""

from __future__ import annotations

import numpy as np
import pytest

from rmw_manycore_py.ndt import MatcherOptions, SerialMatcher, VoxelMap
from rmw_manycore_py.ndt.geometry import poses
from rmw_manycore_py.ndt.geometry.arrays import Pose
from rmw_manycore_py.ndt.simulation.drive import poses_along, scans_along
from rmw_manycore_py.ndt.simulation.lidar import Lidar
from rmw_manycore_py.ndt.simulation.street import Street, build_street
from rmw_manycore_py.ndt.trust.along import Along
from rmw_manycore_py.ndt.trust.judge import PoseJudge
from rmw_manycore_py.ndt.trust.look_along import LookAlong
from rmw_manycore_py.ndt.trust.looks import ScanAt

pytestmark = pytest.mark.unit

OPTIONS = MatcherOptions(search="radius")
LIDAR = Lidar(rings=16, azimuths=300)
LENGTH_M, SPEED_M_S, PERIOD_S = 80.0, 10.0, 0.1


@pytest.fixture(scope="module")
def world() -> tuple[Street, VoxelMap]:
    street = build_street(LENGTH_M, np.random.default_rng(3))
    places = poses_along(np.arange(0.0, LENGTH_M, 4.0), side_m=0.6)
    scans = scans_along(street, places, LIDAR, np.random.default_rng(9))
    points = [poses.transform(T, scan) for T, scan in zip(places, scans, strict=True)]
    return street, VoxelMap.from_points(np.concatenate(points), OPTIONS)


def scan_at(street: Street, T: Pose) -> np.ndarray:
    return LIDAR.scan(street, T, np.random.default_rng(5))


@pytest.mark.parametrize("gap_s", [0.8, 2.0])
def test_after_a_gap_a_guess_that_stayed_behind_does_not_mislead(world, gap_s):
    street, voxel_map = world
    matcher = SerialMatcher(OPTIONS)
    matcher.set_map(voxel_map)
    judge = PoseJudge()
    judge.level.map_changed(voxel_map.own_score)
    look = LookAlong(matcher, judge)
    look.map_changed(voxel_map)
    path = poses_along(20.0 + SPEED_M_S * PERIOD_S * np.arange(8))
    for index, T in enumerate(path):
        found = matcher.align_once(scan_at(street, T), T)
        judge.believe(index * PERIOD_S, found, T)
    stamp_s = (len(path) - 1) * PERIOD_S + gap_s
    truth = poses_along([float(path[-1][0, 3]) + SPEED_M_S * gap_s])[0]
    scan, stale = scan_at(street, truth), path[-1]
    first = matcher.align_once(scan, stale)
    assert poses.distance_m(first.T_map_sensor, truth) > 2.0
    verdict = judge.judge(stamp_s, first, stale)
    assert not (verdict.is_believed and verdict.is_sure)
    found = look.look(ScanAt(stamp_s, scan, stale, None), verdict)
    assert found is not None
    assert poses.distance_m(found[0].T_map_sensor, truth) < 0.2


def test_places_lie_within_reach_nearest_first():
    along = Along(np.array([0.0, 1.0]), 10.0)
    offsets = [along.offset_m(np.eye(4), place) for place in along.places(np.eye(4))]
    assert offsets[0] == 0.0
    assert max(offsets) == -min(offsets) == pytest.approx(along.reach_m)
    assert np.diff(sorted(offsets)).max() < 4.0
    assert len(Along(np.array([1.0, 0.0]), 1e4).places(np.eye(4))) == 41
