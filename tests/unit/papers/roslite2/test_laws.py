# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The control laws equal the case study's formulas on 1,000 random inputs each.

The expected values are computed with complex numbers, matrices and sorted triples where the laws
use trigonometry, scalars and comparisons.
"""

from __future__ import annotations

import cmath
import math
from statistics import median

import numpy as np
import pytest

from rmw_manycore_py.papers.roslite2.laws import odometry
from rmw_manycore_py.papers.roslite2.laws.following import (
    PlanarPose,
    acceleration_m_s2,
    lateral_deviation_m,
    steering_rad,
    yaw_deviation_rad,
)
from rmw_manycore_py.papers.roslite2.laws.wheelchair import wheelchair_twist

pytestmark = pytest.mark.unit

COUNT = 1000


def rows(*ranges: tuple[float, float]) -> list[tuple[float, ...]]:
    """Return random inputs, each number from its range."""
    generator = np.random.default_rng(20)
    columns = [generator.uniform(low, high, COUNT) for low, high in ranges]
    return [tuple(row) for row in np.column_stack(columns).tolist()]


def test_the_lateral_deviation_is_the_imaginary_part_in_the_frame_of_the_pose():
    for x, y, yaw, to_x, to_y in rows((-50, 50), (-50, 50), (-10, 10), (-50, 50), (-50, 50)):
        relative = (complex(to_x, to_y) - complex(x, y)) * cmath.exp(-1j * yaw)
        found = lateral_deviation_m(PlanarPose(x, y, yaw), to_x, to_y)
        assert found == pytest.approx(relative.imag, abs=1e-9)


def test_the_yaw_deviation_is_the_phase_between_headings():
    for base, yaw in rows((-10, 10), (-10, 10)):
        expected = cmath.phase(cmath.exp(1j * yaw) / cmath.exp(1j * base))
        assert yaw_deviation_rad(PlanarPose(0, 0, base), yaw) == pytest.approx(expected, abs=1e-9)


def test_steering():
    """kp = 2 * 4.0 / L^2, kd = 2 * 4.0 / L, L = 3 + 3 * |v|, within 0.6 to both sides."""
    limited = 0
    for lateral, yaw, speed in rows((-3, 3), (-1, 1), (-3, 3)):
        way = 3 + 3 * max(speed, -speed)
        gains = np.array([8 / way / way, 8 / way])
        wanted = -float(gains @ (lateral, yaw))
        expected = sorted((-0.6, wanted, 0.6))[1]
        limited += expected != wanted
        assert steering_rad(lateral, yaw, speed) == pytest.approx(expected, abs=1e-12)
    assert 100 < limited < 900  # both cases occurred


def test_acceleration():
    """-0.5 * (v - target), within 2 to both sides."""
    limited = 0
    for speed, target in rows((-6, 6), (-6, 6)):
        wanted = (target - speed) / 2
        expected = median((-2.0, wanted, 2.0))
        limited += expected != wanted
        assert acceleration_m_s2(speed, target) == pytest.approx(expected, abs=1e-12)
    assert 100 < limited < 900


def test_the_twist_of_the_wheelchair():
    """At most 1.67 m/s; the turn rate is that of a circle of the radius base / tan(angle)."""
    limited = 0
    for speed, angle, base in rows((-1, 3), (-0.6, 0.6), (0.2, 3.0)):
        expected = speed if speed < 1.67 else 1.67
        limited += expected != speed
        radius = base * math.cos(angle) / math.sin(angle)
        found = wheelchair_twist(speed, angle, base)
        assert found == pytest.approx((expected, expected / radius), rel=1e-9)
    assert 100 < limited < 900


def test_the_covariance_of_a_velocity():
    """Squares of the deviations at x and about z, 10000 on the rest of the diagonal."""
    for stddev_vx, stddev_wz in rows((0, 5), (0, 5)):
        expected = np.diag([stddev_vx * stddev_vx, 1e4, 1e4, 1e4, 1e4, stddev_wz * stddev_wz])
        found = odometry.velocity_covariance(stddev_vx, stddev_wz)
        np.testing.assert_allclose(np.reshape(found, (6, 6)), expected, rtol=1e-12)


def test_the_covariance_of_a_speed_and_a_gyroscope():
    for speed, *about in rows((0, 5), (0, 1), (0, 1), (0, 1)):
        expected = np.diag([speed, 1e4, 1e4, *about])
        found = odometry.gyro_covariance(speed, tuple(about))
        np.testing.assert_array_equal(np.reshape(found, (6, 6)), expected)


def test_a_vehicle_stands_where_both_speed_and_yaw_rate_are_below_a_hundredth():
    standing = 0
    for rate, speed in rows((-0.02, 0.02), (-0.02, 0.02)):
        expected = np.linalg.norm((rate, speed), np.inf) < 0.01
        standing += expected
        assert odometry.is_standing(rate, speed) == expected
    assert 100 < standing < 900


def test_a_stamp_is_stale_when_it_is_further_from_now_than_the_timeout():
    stale = 0
    for stamp, now, timeout in rows((0, 1), (0, 1), (0.1, 0.5)):
        expected = (now - stamp) ** 2 > timeout**2
        stale += expected
        assert odometry.is_stale(stamp, now, timeout) == expected
    assert 100 < stale < 900


def test_the_motion_of_two_motors():
    """The right motor counts backwards; km/h to m/s is a division by 3.6."""
    for left, right, width in rows((-6, 6), (-6, 6), (0.3, 1.0)):
        wheels = np.array([left, -right]) / 3.6
        forward = np.array([[0.5, 0.5], [-1 / width, 1 / width]]) @ wheels
        assert odometry.speed_of_motors(left, right, width) == pytest.approx(forward, abs=1e-9)
        back = odometry.motors_of_speed(*forward, width)
        assert back == pytest.approx((left, right), abs=1e-9)


def test_the_steering_angle_of_a_motion():
    for speed, rate, base in rows((0.05, 2), (-1, 1), (0.2, 3.0)):
        expected = cmath.phase(complex(speed, rate * base))
        found = odometry.steering_of_motion(speed, rate, base)
        assert found == pytest.approx(expected, abs=1e-9)
    assert odometry.steering_of_motion(0.0, 1.0, 1.0) == 0.0
