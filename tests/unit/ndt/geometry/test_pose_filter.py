# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The filter tracks a vehicle, also when measurements are late or missing."""

from __future__ import annotations

import numpy as np
import pytest

from rmw_manycore_py.ndt.geometry.pose_filter import PoseFilter
from rmw_manycore_py.ndt.geometry.poses import angle_rad, distance_m, from_xyz_rpy, perturbed

pytestmark = pytest.mark.unit

COVARIANCE = np.diag([0.0225, 0.0225, 0.0225, 0.000625, 0.000625, 0.000625])
SPEED_M_S, TURN_RAD_S = 8.0, 0.3


def circle(time_s: float) -> np.ndarray:
    """Return the pose of a vehicle that drives in a circle, starting at yaw 3 so that it wraps."""
    yaw, radius_m = 3.0 + TURN_RAD_S * time_s, SPEED_M_S / TURN_RAD_S
    position = (radius_m * np.sin(yaw), -radius_m * np.cos(yaw), 1.5)
    return from_xyz_rpy(position, (0.02, -0.01, yaw))


def started() -> PoseFilter:
    pose_filter = PoseFilter()
    pose_filter.initialize(0.0, circle(0.0), COVARIANCE)
    return pose_filter


def test_it_learns_the_speed_from_poses():
    pose_filter = started()
    generator = np.random.default_rng(1)
    for time_s in np.arange(0.1, 5.0, 0.1):
        noisy = perturbed(circle(time_s), 0.03, 0.002, generator)
        assert pose_filter.add_pose(time_s, noisy, COVARIANCE)
    state = pose_filter.predicted(5.0)
    assert state.mean[3] == pytest.approx(SPEED_M_S, rel=0.1)
    assert state.mean[4] == pytest.approx(TURN_RAD_S, abs=0.1)
    assert distance_m(state.pose(), circle(5.0)) < 0.2
    assert angle_rad(state.pose(), circle(5.0)) < 0.03


def test_a_late_measurement_counts_as_if_it_had_come_in_time():
    in_time, late = started(), started()
    measured = [(0.1 * n, circle(0.1 * n)) for n in range(1, 8)]
    for time_s, T in measured:
        assert in_time.add_pose(time_s, T, COVARIANCE)
    for time_s, T in [measured[i] for i in (0, 2, 1, 3, 5, 6, 4)]:
        assert late.add_pose(time_s, T, COVARIANCE)
    np.testing.assert_allclose(late.predicted(1.0).mean, in_time.predicted(1.0).mean, atol=1e-9)
    covariances = [f.predicted(1.0).covariance for f in (late, in_time)]
    np.testing.assert_allclose(*covariances, atol=1e-9)


def test_what_is_older_than_the_history_is_refused():
    pose_filter = started()
    for time_s in np.arange(0.5, 5.0, 0.5):
        pose_filter.add_pose(time_s, circle(time_s), COVARIANCE)
    before = pose_filter.predicted(5.0).mean
    assert not pose_filter.add_pose(1.0, circle(1.0), COVARIANCE)
    np.testing.assert_array_equal(pose_filter.predicted(5.0).mean, before)


def test_a_clock_that_jumps_back():
    """Between measurements they may be ahead of it a little; the place is kept, and corrected."""
    pose_filter = started()
    for time_s in np.arange(0.1, 5.0, 0.1):
        pose_filter.add_pose(time_s, circle(time_s), COVARIANCE)
    assert not pose_filter.follow_clock(4.6)
    assert pose_filter.is_ahead(5.2, 4.6)
    assert not pose_filter.is_ahead(5.0, 4.6)
    place = pose_filter.predicted(0.0).pose()
    assert pose_filter.follow_clock(1.0)
    np.testing.assert_array_equal(pose_filter.predicted(1.0).pose(), place)
    assert pose_filter.predicted(1.0).stamp_s == 1.0
    assert not pose_filter.follow_clock(1.0)
    for time_s in np.arange(1.1, 3.0, 0.1):
        assert pose_filter.add_pose(time_s, circle(time_s), COVARIANCE)
    assert distance_m(pose_filter.predicted(3.0).pose(), circle(3.0)) < 0.2


def test_a_twist_is_enough_to_go_on():
    pose_filter = started()
    for time_s in np.arange(0.02, 2.0, 0.02):
        pose_filter.add_twist(time_s, SPEED_M_S, TURN_RAD_S, np.diag([0.01, 0.001]))
    assert distance_m(pose_filter.predicted(2.0).pose(), circle(2.0)) < 0.5


def test_what_moves_sideways_is_not_left_behind():
    """A hand-held LiDAR, or one not mounted straight ahead: 3 m/s to its left."""
    pose_filter = PoseFilter()
    pose_filter.initialize(0.0, np.eye(4), COVARIANCE)
    for time_s in np.arange(0.1, 5.0, 0.1):
        pose_filter.add_twist(time_s, 0.0, 0.0, np.diag([0.04, 0.01]))
        sideways = from_xyz_rpy((0.0, 3.0 * time_s, 0.0))
        assert distance_m(pose_filter.predicted(time_s).pose(), sideways) < 0.6
        pose_filter.add_pose(time_s, sideways, COVARIANCE)


def test_uncertainty_grows_with_time_and_shrinks_with_measurements():
    pose_filter = started()

    def variance() -> float:
        return float(np.trace(pose_filter.predicted(0.5).pose_covariance()))

    first = variance()
    pose_filter.add_pose(0.4, circle(0.4), COVARIANCE)
    assert variance() < first
    later = np.trace(pose_filter.predicted(1.5).pose_covariance())
    assert later > variance()
