# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Speeds of wheels and vehicle, and their covariances.

Sources: vehicle_velocity_converter and gyro_odometer of Autoware Universe, tier4's WHILL adapter.
"""

from __future__ import annotations

import math

NOT_MEASURED = 10_000.0  # variance of unmeasured components
STANDSTILL_RATE_RAD_S, STANDSTILL_SPEED_M_S = 0.01, 0.01
KM_H_PER_M_S = 3.6

Covariance = tuple[float, ...]  # (36), row by row: x, y, z, about x, about y, about z


def diagonal_covariance(variances: tuple[float, float, float, float, float, float]) -> Covariance:
    """Return a covariance (36) with this diagonal."""
    return tuple(
        variances[row] if row == column else 0.0 for row in range(6) for column in range(6)
    )


def velocity_covariance(stddev_vx_m_s: float, stddev_wz_rad_s: float) -> Covariance:
    """Return the covariance of a speed and a yaw rate; other components are unmeasured."""
    unknown = NOT_MEASURED
    return diagonal_covariance(
        (stddev_vx_m_s**2, unknown, unknown, unknown, unknown, stddev_wz_rad_s**2)
    )


def gyro_covariance(
    speed_variance: float, gyro_variances: tuple[float, float, float]
) -> Covariance:
    """Return the covariance of a wheel speed combined with turn rates of the gyroscope."""
    return diagonal_covariance((speed_variance, NOT_MEASURED, NOT_MEASURED, *gyro_variances))


def is_standing(yaw_rate_rad_s: float, speed_m_s: float) -> bool:
    """Return whether a vehicle stands, so that the gyroscope only shows its bias."""
    return abs(yaw_rate_rad_s) < STANDSTILL_RATE_RAD_S and abs(speed_m_s) < STANDSTILL_SPEED_M_S


def is_stale(stamp_s: float, now_s: float, timeout_s: float) -> bool:
    """Return whether a stamp is too far from now, in either direction."""
    return abs(now_s - stamp_s) > timeout_s


def speed_of_motors(left_km_h: float, right_km_h: float, tread_m: float) -> tuple[float, float]:
    """Return speed (m/s) and yaw rate (rad/s); the right motor counts backwards."""
    speed_m_s = (left_km_h - right_km_h) / 2.0 / KM_H_PER_M_S
    return speed_m_s, -(left_km_h + right_km_h) / KM_H_PER_M_S / tread_m


def motors_of_speed(speed_m_s: float, yaw_rate_rad_s: float, tread_m: float) -> tuple[float, float]:
    """Return the speeds of the left and right motor (km/h); the inverse of `speed_of_motors`."""
    half_turn_m_s = 0.5 * tread_m * yaw_rate_rad_s
    left, right = speed_m_s - half_turn_m_s, speed_m_s + half_turn_m_s
    return KM_H_PER_M_S * left, -KM_H_PER_M_S * right


def steering_of_motion(speed_m_s: float, yaw_rate_rad_s: float, wheel_base_m: float) -> float:
    """Return the steering angle (rad) of a bicycle model with this motion; 0 at standstill."""
    return math.atan(yaw_rate_rad_s * wheel_base_m / speed_m_s) if speed_m_s != 0.0 else 0.0
