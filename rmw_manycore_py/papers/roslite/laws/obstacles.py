# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Stopping before obstacles on the lane. Source: velocity_set of Autoware.AI."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rmw_manycore_py.papers.roslite.laws.lanes import NONE, Column, Place, Waypoints, braked


@dataclass(frozen=True)
class StopRule:
    """When a waypoint is blocked, and how the vehicle stops before it; Autoware's defaults."""

    range_m: float = 1.3
    min_points: int = 10
    bottom_m: float = -1.7  # in the sensor's frame
    top_m: float = 0.2
    distance_m: float = 10.0  # between the vehicle and the obstacle
    deceleration_m_s2: float = 0.8


def points_on_map(points_m: NDArray[np.float32], place: Place, rule: StopRule) -> Column:
    """Return those points (n, 2) in the map frame that are as high as an obstacle.

    :param points_m: (N, 3) in the sensor's frame.
    """
    high = (points_m[:, 2] > rule.bottom_m) & (points_m[:, 2] < rule.top_m)
    x, y = points_m[high, 0].astype(np.float64), points_m[high, 1].astype(np.float64)
    cos, sin = np.cos(place.yaw_rad), np.sin(place.yaw_rad)
    return np.stack([place.x_m + cos * x - sin * y, place.y_m + sin * x + cos * y], axis=1)


def blocked_waypoint(lane: Waypoints, obstacles_m: Column, rule: StopRule) -> int:
    """Return the first waypoint with enough points (n, 2) in range; NONE without one."""
    if not len(lane) or not len(obstacles_m):
        return NONE
    waypoints_m = np.stack([lane.x_m, lane.y_m], axis=1)
    offsets = waypoints_m[:, None, :] - obstacles_m[None, :, :]
    near = (offsets**2).sum(axis=2) < rule.range_m**2
    blocked = np.flatnonzero(near.sum(axis=1) >= rule.min_points)
    return int(blocked[0]) if len(blocked) else NONE


def stopped_before(lane: Waypoints, blocked: int, rule: StopRule) -> Waypoints:
    """Return a lane on which the vehicle stops in time before a blocked waypoint."""
    along_m = lane.along_m
    stop = int(np.searchsorted(along_m, along_m[blocked] - rule.distance_m, side="right")) - 1
    return braked(lane, max(stop, 0), rule.deceleration_m_s2)
