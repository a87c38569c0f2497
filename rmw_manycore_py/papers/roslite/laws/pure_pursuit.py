# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Pure pursuit: the arc to a point of the lane ahead. Source: pure_pursuit of Autoware.AI."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from rmw_manycore_py.papers.roslite.laws.lanes import Place, Waypoints


@dataclass(frozen=True)
class PursuitRule:
    """Autoware's defaults."""

    ratio_s: float = 2.0  # lookahead distance per speed
    min_m: float = 6.0
    max_s: float = 10.0
    wheel_base_m: float = 2.7


@dataclass(frozen=True)
class Pursuit:
    """What the vehicle is to do next."""

    speed_m_s: float
    curvature_1_m: float  # positive to the left
    acceleration_m_s2: float
    steering_rad: float

    @property
    def yaw_rate_rad_s(self) -> float:
        """Yaw rate at the speed."""
        return self.curvature_1_m * self.speed_m_s


def lookahead_m(speed_m_s: float, rule: PursuitRule) -> float:
    """Return how far ahead the target is at a speed."""
    max_m = speed_m_s * rule.max_s
    return max(rule.min_m, min(speed_m_s * rule.ratio_s, max_m))


def target(lane: Waypoints, place: Place, distance_m: float) -> tuple[float, float]:
    """Return where the lane leaves the circle of this radius; its last waypoint if it does not."""
    distances = lane.distances_m(place)
    beyond = np.flatnonzero(distances > distance_m)
    after = int(beyond[beyond > 0][0]) if (beyond > 0).any() else len(lane) - 1
    end = float(lane.x_m[after]), float(lane.y_m[after])
    if after == 0 or distances[after] <= distance_m or distances[after - 1] > distance_m:
        return end
    start = float(lane.x_m[after - 1]), float(lane.y_m[after - 1])
    share = _crossing(start, end, (place.x_m, place.y_m), distance_m)
    return start[0] + share * (end[0] - start[0]), start[1] + share * (end[1] - start[1])


def _crossing(
    start: tuple[float, float], end: tuple[float, float], centre: tuple[float, float], radius: float
) -> float:
    """Return where a segment from inside a circle leaves it, from 0 to 1."""
    dx, dy = end[0] - start[0], end[1] - start[1]
    fx, fy = start[0] - centre[0], start[1] - centre[1]
    a, b, c = dx * dx + dy * dy, fx * dx + fy * dy, fx * fx + fy * fy - radius * radius
    return (-b + math.sqrt(b * b - a * c)) / a


def curvature_1_m(place: Place, x_m: float, y_m: float) -> float:
    """Return the curvature of the arc to a point, positive to the left."""
    dx, dy = x_m - place.x_m, y_m - place.y_m
    squared_m2 = dx * dx + dy * dy
    if squared_m2 == 0.0:
        return 0.0
    left_m = math.cos(place.yaw_rad) * dy - math.sin(place.yaw_rad) * dx
    return 2.0 * left_m / squared_m2


def pursue(lane: Waypoints, place: Place, speed_m_s: float, rule: PursuitRule) -> Pursuit:
    """Return the command for a lane that begins at the vehicle and has at least one waypoint."""
    wanted_m_s = float(lane.speed_m_s[0])
    curvature = curvature_1_m(place, *target(lane, place, lookahead_m(speed_m_s, rule)))
    ahead_m = float(lane.distances_m(place)[min(1, len(lane) - 1)])
    squares = wanted_m_s**2 - speed_m_s**2
    return Pursuit(
        wanted_m_s,
        curvature,
        squares / (2.0 * ahead_m) if ahead_m > 0.0 else 0.0,
        math.atan(rule.wheel_base_m * curvature),
    )
