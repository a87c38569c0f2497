# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Lanes: waypoints with speeds, the closest one, and speeds from which a vehicle can stop."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

Column = NDArray[np.float64]  # (N,)
NONE = -1


@dataclass(frozen=True)
class Place:
    """Pose of the vehicle in the map frame."""

    x_m: float
    y_m: float
    yaw_rad: float


@dataclass(frozen=True)
class Waypoints:
    """Positions (N,) and headings (N,) in the map frame, and speeds (N,)."""

    x_m: Column
    y_m: Column
    yaw_rad: Column
    speed_m_s: Column

    def __len__(self) -> int:
        return len(self.x_m)

    def distances_m(self, place: Place) -> Column:
        """Return the distances (N,) from a place."""
        return np.hypot(self.x_m - place.x_m, self.y_m - place.y_m)

    @property
    def along_m(self) -> Column:
        """The way (N,) along the lane from the first waypoint."""
        steps = np.hypot(np.diff(self.x_m), np.diff(self.y_m))
        return np.concatenate([[0.0], np.cumsum(steps)])

    def slower(self, limit_m_s: Column) -> Waypoints:
        """Return the waypoints with speeds of at most these (N,)."""
        return replace(self, speed_m_s=np.minimum(self.speed_m_s, limit_m_s))


def braked(lane: Waypoints, stop: int, deceleration_m_s2: float) -> Waypoints:
    """Return a lane on which a vehicle stops at a waypoint: v^2 = 2 a d before it, 0 behind."""
    left_m = np.maximum(lane.along_m[stop] - lane.along_m, 0.0)
    return lane.slower(np.sqrt(2.0 * deceleration_m_s2 * left_m))


def closest_waypoint(lane: Waypoints, place: Place) -> int:
    """Return the nearest waypoint that heads within 90 degrees of the vehicle; NONE without one."""
    distances = lane.distances_m(place)
    distances = np.where(np.cos(lane.yaw_rad - place.yaw_rad) > 0.0, distances, np.inf)
    if not len(distances) or not math.isfinite(distances.min()):
        return NONE
    return int(distances.argmin())


def nearest_lane(lanes: list[Waypoints], place: Place) -> tuple[int, int]:
    """Return lane and waypoint nearest to a place; NONE without one."""
    found = [closest_waypoint(lane, place) for lane in lanes]
    distances = [
        math.inf if at == NONE else float(lane.distances_m(place)[at])
        for lane, at in zip(lanes, found, strict=True)
    ]
    best = int(np.argmin(distances)) if distances else NONE
    return (best, found[best]) if best != NONE and found[best] != NONE else (NONE, NONE)
