# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Limit and low pass of commands. Source: twist_filter of Autoware.AI."""

from __future__ import annotations

from dataclasses import dataclass

STRAIGHT_RAD_S = 1e-8


@dataclass(frozen=True)
class FilterRule:
    """Autoware's defaults; a gain of 0 lets everything pass."""

    lateral_m_s2: float = 5.0
    gain_speed: float = 0.0
    gain_yaw_rate: float = 0.0


@dataclass
class TwistFilter:
    """Slows down in curves, and smooths what it has slowed down."""

    rule: FilterRule
    _speed_m_s: float = 0.0
    _yaw_rate_rad_s: float = 0.0

    def __call__(self, speed_m_s: float, yaw_rate_rad_s: float) -> tuple[float, float]:
        """Return speed and yaw rate to drive; straight ahead nothing is changed."""
        if abs(yaw_rate_rad_s) < STRAIGHT_RAD_S:
            return speed_m_s, yaw_rate_rad_s
        if abs(speed_m_s * yaw_rate_rad_s) > self.rule.lateral_m_s2:
            speed_m_s = self.rule.lateral_m_s2 / abs(yaw_rate_rad_s)
        self._speed_m_s = _mixed(self.rule.gain_speed, self._speed_m_s, speed_m_s)
        self._yaw_rate_rad_s = _mixed(self.rule.gain_yaw_rate, self._yaw_rate_rad_s, yaw_rate_rad_s)
        return self._speed_m_s, self._yaw_rate_rad_s


def _mixed(gain: float, before: float, now: float) -> float:
    return gain * before + (1.0 - gain) * now
