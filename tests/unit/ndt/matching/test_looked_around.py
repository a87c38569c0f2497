# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Where no look from a guess convinces, the places around it are searched."""

from __future__ import annotations

import numpy as np
import pytest

from rmw_manycore_py.bench.ndt.trust_worlds import Drive, simulated
from rmw_manycore_py.ndt import MatcherOptions, SerialMatcher, VoxelMap, WorkerMatcher
from rmw_manycore_py.ndt.geometry.arrays import Pose
from rmw_manycore_py.ndt.matching import voxel_map as voxel_maps
from rmw_manycore_py.ndt.matching.second_look import CONVINCING_SHARE
from support.samples.ndt_world import errors, pose

pytestmark = pytest.mark.unit

INDEX = 20
HIDDEN = 65  # a scan with many points where the sparse map has nothing
OPTIONS = MatcherOptions(search="radius")


@pytest.fixture(scope="module")
def drive() -> Drive:
    return simulated()["street, sparse map"]()


@pytest.fixture
def matcher(drive: Drive) -> SerialMatcher:
    made = SerialMatcher(OPTIONS)
    made.set_map(VoxelMap.from_points(drive.map_points, OPTIONS))
    return made


def far_guesses(truth: Pose) -> list[Pose]:
    """Return guesses 8 m off in eight directions, turned by 45 degrees, some tilted."""
    directions = np.arange(8) * np.pi / 4
    return [
        truth @ pose(8 * np.cos(a), 8 * np.sin(a), 0, 0.2 * (i % 3), 0, (-1) ** i * np.pi / 4)
        for i, a in enumerate(directions)
    ]


def distances_m(matcher: SerialMatcher, drive: Drive) -> list[float]:
    truth = drive.poses[INDEX]
    found = [matcher.align(drive.scan(INDEX), guess) for guess in far_guesses(truth)]
    return [errors(one.T_map_sensor, truth)[0] for one in found]


def test_a_scan_is_found_from_8_m_and_45_degrees(drive, matcher, monkeypatch):
    assert max(distances_m(matcher, drive)) < 0.2
    too_large = SerialMatcher(OPTIONS)
    with monkeypatch.context() as context:
        context.setattr(voxel_maps, "MAX_SEARCH_MAP_BYTES", 1000)
        too_large.set_map(VoxelMap.from_points(drive.map_points, OPTIONS))
        assert max(distances_m(too_large, drive)) > 1.0


def test_a_right_place_that_only_evidence_supports_ends_a_second_look(drive, matcher):
    truth = drive.poses[HIDDEN]
    guess = truth @ pose(-3.5, 3.5, 0, 0, 0, -0.35)
    assert errors(matcher.align_once(drive.scan(HIDDEN), guess).T_map_sensor, truth)[0] > 1.0
    found = matcher.align(drive.scan(HIDDEN), guess)
    assert errors(found.T_map_sensor, truth)[0] < 0.1
    own = matcher.map.own_score
    assert found.fit < CONVINCING_SHARE * own
    assert found.explained_score > CONVINCING_SHARE * own
    assert found.looks < 6


def test_workers_find_the_same(drive, matcher):
    scan, guess = drive.scan(INDEX), far_guesses(drive.poses[INDEX])[0]
    expected = matcher.align(scan, guess)
    with WorkerMatcher(OPTIONS, [0, 0, 0]) as workers:
        workers.set_map(matcher.map)
        found = workers.align(scan, guess)
    assert found.T_map_sensor.tolist() == expected.T_map_sensor.tolist()
    assert found.looks == expected.looks
    assert found.looks > 6  # a second look was not enough
