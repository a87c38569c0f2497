# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Commands of the wheelchair. Source: the sender of tier4's WHILL adapter."""

from __future__ import annotations

import math

MAX_SPEED_M_S = 1.67  # 6 km/h


def wheelchair_twist(
    speed_m_s: float, steering_rad: float, wheel_base_m: float, max_speed_m_s: float = MAX_SPEED_M_S
) -> tuple[float, float]:
    """Return speed (m/s) and yaw rate (rad/s) for a command in steering angle."""
    limited_m_s = min(speed_m_s, max_speed_m_s)
    return limited_m_s, limited_m_s * math.tan(steering_rad) / wheel_base_m
