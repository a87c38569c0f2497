# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Plant model of the wheelchair: two driven wheels that follow commands with a lag."""

from __future__ import annotations

import math
from dataclasses import dataclass

COMMAND_TIMEOUT_S = 0.5


@dataclass(frozen=True)
class PlantOptions:
    """Parameters of the plant; the wheels are first-order systems."""

    tread_m: float = 0.5
    lag_s: float = 0.12
    command_timeout_s: float = COMMAND_TIMEOUT_S


@dataclass
class Plant:
    """Pose in the map frame, wheel speeds in m/s, times in seconds of one clock."""

    options: PlantOptions
    x_m: float
    y_m: float
    yaw_rad: float
    left_m_s: float = 0.0
    right_m_s: float = 0.0
    _wanted_m_s: tuple[float, float] = (0.0, 0.0)
    _commanded_s: float = -math.inf

    def command(self, now_s: float, speed_m_s: float, yaw_rate_rad_s: float) -> None:
        """Set a command; a non-finite one stops the vehicle."""
        is_finite = math.isfinite(speed_m_s) and math.isfinite(yaw_rate_rad_s)
        speed, rate = (speed_m_s, yaw_rate_rad_s) if is_finite else (0.0, 0.0)
        half_turn = 0.5 * self.options.tread_m * rate
        self._wanted_m_s = (speed - half_turn, speed + half_turn)
        self._commanded_s = now_s

    def is_timed_out(self, now_s: float) -> bool:
        """Return whether the last command is too old to be followed."""
        return now_s - self._commanded_s > self.options.command_timeout_s

    def advance(self, now_s: float, step_s: float) -> None:
        """Simulate a step that ends now: wheels first, then an arc with their new speeds."""
        wanted = (0.0, 0.0) if self.is_timed_out(now_s) else self._wanted_m_s
        share = 1.0 - math.exp(-step_s / self.options.lag_s)
        self.left_m_s += share * (wanted[0] - self.left_m_s)
        self.right_m_s += share * (wanted[1] - self.right_m_s)
        middle = self.yaw_rad + 0.5 * step_s * self.yaw_rate_rad_s
        self.x_m += step_s * self.speed_m_s * math.cos(middle)
        self.y_m += step_s * self.speed_m_s * math.sin(middle)
        self.yaw_rad += step_s * self.yaw_rate_rad_s

    @property
    def speed_m_s(self) -> float:
        """Forward speed."""
        return 0.5 * (self.left_m_s + self.right_m_s)

    @property
    def yaw_rate_rad_s(self) -> float:
        """Yaw rate, positive to the left."""
        return (self.right_m_s - self.left_m_s) / self.options.tread_m
