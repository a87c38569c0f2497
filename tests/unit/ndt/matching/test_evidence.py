# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What the map can contradict: vehicles and unmapped places say nothing about a pose."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

from rmw_manycore_py.bench.ndt import trust_variants
from rmw_manycore_py.bench.ndt.trust_worlds import Drive, simulated
from rmw_manycore_py.ndt import Alignment, MatcherOptions, SerialMatcher, VoxelMap
from rmw_manycore_py.ndt.geometry import poses
from rmw_manycore_py.ndt.geometry.arrays import scan_points
from rmw_manycore_py.ndt.matching.evidence import known_points, sample_of
from rmw_manycore_py.ndt.trust.judge import PoseJudge
from support.samples.ndt_world import pose, street

pytestmark = pytest.mark.unit

DEFAULT = MatcherOptions(search="radius")
WRONG = ((3.0, 0.7), (5.0, 0.35), (1.0, 3.1))  # m, rad


@pytest.fixture(scope="module")
def drive() -> Drive:
    return simulated()["street 1"]()


def test_points_are_classified():
    voxel_map = VoxelMap.from_points(street(), DEFAULT)
    at = pose(36.0, 0.0, 1.8, 0.0, 0.0, 0.0)
    points = {
        "on the ground": (20.0, 3.0, -1.8),
        "on a wall": (0.0, 8.0, 1.0),
        "in the road": (6.0, 0.0, -0.8),
        "behind a wall": (1.75, 14.0, 2.1),
        "beyond a gap": (12.0, 14.0, 1.0),
        "far behind a wall": (1.75e34, 14.0e34, 2.1e34),
        "far in the sky": (0.0, 0.0, 3e38),
        "nowhere": (np.nan, 0.0, 0.0),
    }
    sensor = np.array(list(points.values()), np.float32)
    found = voxel_map.finest.point_evidence(sensor, at, DEFAULT.outlier_ratio)
    evidence = dict(zip(points, found, strict=True))
    is_past = {name for name, one in evidence.items() if one[3] > 0}
    assert is_past == {"behind a wall", "far behind a wall"}
    without_column = {name for name, one in evidence.items() if np.isnan(one[1])}
    assert without_column == {"behind a wall", "beyond a gap", "far behind a wall", "nowhere"}
    around = voxel_map.finest.columns_around(sensor, at)
    known = ~np.isnan(found[:, 1])
    np.testing.assert_array_equal(around, np.where(known, found[:, 2], 0.0))
    np.testing.assert_array_equal(
        known_points(voxel_map.finest, sensor, at), sensor[known & (found[:, 2] > 5)]
    )
    assert evidence["on the ground"][1] == pytest.approx(0.0, abs=0.1)
    assert evidence["in the road"][1] == pytest.approx(1.0, abs=0.1)
    assert evidence["in the road"][2] == 8
    assert evidence["on a wall"][2] < 8
    assert evidence["on a wall"][0] > 0.5 * voxel_map.own_score


def test_heights_are_above_the_floor_of_the_sensors_storey():
    x, y = np.meshgrid(np.arange(0.0, 40.0, 0.2), np.arange(0.0, 40.0, 0.2))
    storey = np.stack([x.ravel(), y.ravel(), np.full(x.size, 0.1)], axis=1)
    up = np.array([0.0, 0.0, 1.0])
    ditch = storey[storey[:, 0] > 30.0] - 2.5 * up
    is_under_sensor = (np.abs(storey[:, :2] - 20.0) < (0.9, 1.4)).all(axis=1)
    roof = storey[is_under_sensor] + 1.5 * up  # of a vehicle that was parked there
    points = np.concatenate([storey, storey + 4.0 * up, ditch, roof, roof + 4.0 * up])
    voxel_map = VoxelMap.from_points(points, MatcherOptions(voxel_size_m=1.0))
    beside, over_ditch = (5.0, 0.0, -0.8), (15.0, 0.0, -0.8)  # 1.8 m above the floor
    for floor_m in (0.1, 4.1):
        at = pose(20.0, 20.0, floor_m + 1.8, 0.0, 0.0, 0.0)
        found = voxel_map.finest.point_evidence(
            np.array([beside, over_ditch], np.float32), at, DEFAULT.outlier_ratio
        )
        np.testing.assert_allclose(found[:, 1], 1.0, atol=0.1)


@pytest.mark.parametrize("change", trust_variants.CHANGES.values(), ids=trust_variants.CHANGES)
def test_right_first_poses_are_believed_within_one_scan_and_wrong_ones_refused(drive, change):
    changed = change(drive)
    voxel_map = VoxelMap.from_points(changed.map_points, changed.options)
    matcher = SerialMatcher(changed.options)
    matcher.set_map(voxel_map)
    generator = np.random.default_rng(2)
    for index in changed.tested[5::30]:
        scan, truth = scan_points(changed.scan(index)), changed.poses[index]
        guess = poses.perturbed(truth, 0.3, 0.03, generator)
        right = matcher.align(scan, guess, only_pose=True)
        assert poses.distance_m(right.T_map_sensor, truth) < 0.2
        assert believed(matcher.explained(right, scan), voxel_map)
        for wrong in wrong_results(matcher, scan, truth):
            assert not believed(matcher.explained(wrong, scan), voxel_map)


def wrong_results(
    matcher: SerialMatcher, scan: np.ndarray, truth: np.ndarray
) -> Iterator[Alignment]:
    """Yield the alignments from guesses far off that did not come home."""
    generator = np.random.default_rng(3)
    for distance_m, angle_rad in WRONG:
        guess = poses.perturbed(truth, distance_m, angle_rad, generator)
        found = matcher.align_once(scan, guess, only_pose=True)
        if poses.distance_m(found.T_map_sensor, truth) > 0.5:
            yield found


def believed(alignment: Alignment, voxel_map: VoxelMap) -> bool:
    judge = PoseJudge()
    judge.level.map_changed(voxel_map.own_score)
    return judge.judge(0.0, alignment, alignment.T_map_sensor).is_believed


def test_a_sample_has_points_of_all_rings():
    for rings in (16, 32, 64, 128):
        scan = np.zeros((40_000, 3), np.float32)
        scan[:, 2] = np.arange(len(scan)) % rings  # column by column
        sample = sample_of(scan)
        assert len(sample) in range(2000, 4000)
        assert len(np.unique(sample[:, 2])) == rings


def test_guard_rails_support_a_pose_and_kerbs_do_not():
    """A motorway: what stands 0.8 m high is all there is."""
    generator = np.random.default_rng(1)
    ground = generator.uniform((-40.0, -9.0, 0.0), (40.0, 9.0, 0.0), (40_000, 3))
    for height_m, is_explained in ((0.8, True), (0.15, False)):
        edges = generator.uniform((-40.0, 7.0, 0.0), (40.0, 7.1, height_m), (20_000, 3))
        edges[::2, 1] *= -1.0
        matcher = SerialMatcher(DEFAULT)
        matcher.set_map(VoxelMap.from_points(np.concatenate([ground, edges]), DEFAULT))
        seen = np.concatenate([ground[::8], edges[::8]]).astype(np.float32)
        score = matcher.explained_score(seen, np.eye(4)) / matcher.map.own_score
        assert (score > 0.9) == is_explained


def test_unexplained_scores_of_vehicles_are_refused(drive):
    """Without the evidence the same poses are refused: the world is hard enough."""
    changed = trust_variants.with_vehicles(drive)
    voxel_map = VoxelMap.from_points(changed.map_points, DEFAULT)
    matcher = SerialMatcher(DEFAULT)
    matcher.set_map(voxel_map)
    scan = scan_points(changed.scan(20))
    found = next(matcher.closer_looks(scan, changed.poses[20], only_pose=True))
    assert not believed(found, voxel_map)
    assert found.nearest_voxel_likelihood < 0.75 * voxel_map.own_score
