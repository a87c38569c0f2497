# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Trajectory following: linearized pure pursuit, and proportional speed control.

Source: simple_trajectory_follower of Autoware Universe. Its gains are those of a car with a wheel
base of 4 m, regardless of the vehicle.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

GAIN_WHEEL_BASE_M = 4.0
MIN_LOOKAHEAD_M, LOOKAHEAD_TIME_S = 3.0, 3.0
MAX_STEERING_RAD = 0.6
SPEED_GAIN_1_S = 0.5
MAX_ACCELERATION_M_S2 = 2.0


@dataclass(frozen=True)
class PlanarPose:
    """Pose of a vehicle or trajectory point in the map frame."""

    x_m: float
    y_m: float
    yaw_rad: float


def lateral_deviation_m(base: PlanarPose, x_m: float, y_m: float) -> float:
    """Return the lateral offset of a position from a pose, positive to the left."""
    return math.cos(base.yaw_rad) * (y_m - base.y_m) - math.sin(base.yaw_rad) * (x_m - base.x_m)


def yaw_deviation_rad(base: PlanarPose, yaw_rad: float) -> float:
    """Return the heading relative to a pose, positive to the left, from -pi to pi."""
    return math.remainder(yaw_rad - base.yaw_rad, 2.0 * math.pi)


def steering_rad(lateral_m: float, yaw_rad: float, speed_m_s: float) -> float:
    """Return the steering angle that corrects both deviations, positive to the left."""
    lookahead_m = MIN_LOOKAHEAD_M + LOOKAHEAD_TIME_S * abs(speed_m_s)
    kp = 2.0 * GAIN_WHEEL_BASE_M / lookahead_m**2
    kd = 2.0 * GAIN_WHEEL_BASE_M / lookahead_m
    return _clamped(-kp * lateral_m - kd * yaw_rad, MAX_STEERING_RAD)


def acceleration_m_s2(speed_m_s: float, target_m_s: float) -> float:
    """Return the acceleration towards a target speed."""
    return _clamped(-SPEED_GAIN_1_S * (speed_m_s - target_m_s), MAX_ACCELERATION_M_S2)


def _clamped(value: float, limit: float) -> float:
    return max(-limit, min(limit, value))
