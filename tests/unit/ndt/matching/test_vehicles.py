# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What may be a vehicle is left out, and an alignment without it comes home."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from rmw_manycore_py.bench.ndt import trust_variants
from rmw_manycore_py.bench.ndt.trust_worlds import simulated
from rmw_manycore_py.ndt import MatcherOptions, SerialMatcher, VoxelMap
from rmw_manycore_py.ndt.geometry import poses
from rmw_manycore_py.ndt.geometry.arrays import ScanPoints, scan_points
from rmw_manycore_py.ndt.matching.vehicles import FARTHEST_M, beyond_vehicles

pytestmark = pytest.mark.unit

OPTIONS = MatcherOptions(search="radius")
SENSOR_M = 1.8  # above the ground
LEVEL = np.eye(4)


def grid(x: np.ndarray, y: np.ndarray, z: np.ndarray) -> ScanPoints:
    return scan_points(np.stack(np.meshgrid(x, y, z), axis=-1).reshape(-1, 3) - [0, 0, SENSOR_M])


GROUND = grid(np.arange(-20, 20, 0.5), np.arange(-20, 20, 0.5), np.zeros(1))
WALL = grid(np.arange(-20, 20, 0.5), np.array([12.0]), np.arange(0.5, 8.0, 0.5))
VEHICLE = grid(np.arange(4, 8, 0.25), np.arange(3, 5, 0.25), np.arange(0.5, 2.0, 0.25))
SCENE = np.concatenate([GROUND, WALL, VEHICLE])


def test_ground_and_what_is_above_vehicles_are_kept():
    kept = beyond_vehicles(SCENE, LEVEL)
    high_walls = WALL[WALL[:, 2] + SENSOR_M > 3.7]
    assert {*map(tuple, kept)} == {*map(tuple, GROUND), *map(tuple, high_walls)}


@pytest.mark.parametrize("height_m", [-300.0, 300.0])
def test_the_height_of_the_map_does_not_matter_but_the_tilt_does(height_m):
    T = poses.from_xyz_rpy((5.0, -3.0, height_m), (0.1, -0.2, 2.0))
    tilted = scan_points(SCENE @ T[:3, :3])
    assert len(beyond_vehicles(tilted, T)) == len(beyond_vehicles(SCENE, LEVEL))
    assert len(beyond_vehicles(tilted, LEVEL)) < 0.8 * len(beyond_vehicles(SCENE, LEVEL))


def test_the_ground_of_a_slope_is_kept():
    slope = scan_points(GROUND + np.outer(GROUND[:, 0], [0, 0, 0.08]))
    assert len(beyond_vehicles(slope, LEVEL)) > 0.9 * len(slope)


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf, 2 * FARTHEST_M, -3e38])
def test_points_that_are_none_are_left_out(bad):
    spoilt = np.concatenate([SCENE, np.full((3, 3), bad, np.float32)])
    assert np.array_equal(beyond_vehicles(spoilt, LEVEL), beyond_vehicles(SCENE, LEVEL))


def test_nothing_remains_of_nothing():
    assert beyond_vehicles(scan_points(np.empty((0, 3))), LEVEL).shape == (0, 3)
    assert beyond_vehicles(scan_points(np.full((5, 3), np.nan)), LEVEL).shape == (0, 3)


def test_where_vehicles_hide_much_scans_come_home_from_a_metre_off():
    """From the guess alone, the finest level does so for nine of ten."""
    drive = trust_variants.with_vehicles(simulated()["street 1"]())
    matcher = SerialMatcher(OPTIONS)
    matcher.set_map(VoxelMap.from_points(drive.map_points, OPTIONS))
    generator = np.random.default_rng(5)
    for index in drive.tested[::3]:
        truth = drive.poses[index]
        guess = poses.perturbed(truth, 1.0, np.radians(5.0), generator)
        found = next(matcher.closer_looks(scan_points(drive.scan(index)), guess))
        assert poses.distance_m(found.T_map_sensor, truth) < 0.1


def test_where_what_no_vehicle_has_misleads_the_guess_itself_leads_home():
    half = trust_variants.CHANGES["40 % on vehicles, no map on the left"]
    drive = half(simulated()["street 1"]())
    matcher = SerialMatcher(OPTIONS)
    matcher.set_map(VoxelMap.from_points(drive.map_points, OPTIONS))
    scan, truth = scan_points(drive.scan(67)), drive.poses[67]
    guess = truth @ poses.from_xyz_rpy((0.5, 0.0, 0.0))
    aside, home = matcher.closer_looks(scan, guess)
    assert poses.distance_m(aside.T_map_sensor, truth) > 1.0
    assert poses.distance_m(home.T_map_sensor, truth) < 0.1
    found = matcher.align(scan, guess)
    assert found.T_map_sensor == pytest.approx(home.T_map_sensor, abs=1e-3)
    assert found.looks == 8  # the first, five of the second look, two closer


def test_the_steps_of_a_closer_look_begin_at_the_guess():
    drive = trust_variants.with_vehicles(simulated()["street 1"]())
    matcher = SerialMatcher(replace(OPTIONS, polish_levels=()))
    matcher.set_map(VoxelMap.from_points(drive.map_points, matcher.options))
    guess = drive.poses[30] @ poses.from_xyz_rpy((1.0, 0.0, 0.0))
    for found in matcher.closer_looks(scan_points(drive.scan(30)), guess):
        np.testing.assert_allclose(found.path[0], guess, atol=1e-6)
        np.testing.assert_array_equal(found.path[-1], found.T_map_sensor)
        assert len(found.path) == 1 + found.iterations
