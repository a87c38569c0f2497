# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Conversions between messages and what the laws and the matcher work with."""

from __future__ import annotations

import math
from array import array
from collections.abc import Sequence
from typing import Any

import numpy as np
from autoware_msgs.msg import Waypoint
from geometry_msgs.msg import PoseStamped, TwistStamped
from numpy.typing import NDArray
from rclpy.qos import DurabilityPolicy, QoSProfile

from rmw_manycore_py.papers.roslite.laws.lanes import Place, Waypoints

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


def waypoints_of(waypoints: Sequence[Any]) -> Waypoints:
    """Return messages of waypoints as arrays."""
    rows = np.empty((len(waypoints), 5))
    for row, one in zip(rows, waypoints, strict=True):
        pose = one.pose.pose
        place, turn = pose.position, pose.orientation
        row[:] = place.x, place.y, turn.z, turn.w, one.twist.twist.linear.x
    yaw = 2.0 * np.arctan2(rows[:, 2], rows[:, 3])
    return Waypoints(rows[:, 0], rows[:, 1], yaw, rows[:, 4])


def set_speeds(waypoints: Sequence[Any], speeds_m_s: NDArray[np.float64]) -> None:
    """Write speeds into messages of waypoints."""
    for waypoint, speed in zip(waypoints, speeds_m_s.tolist(), strict=True):
        waypoint.twist.twist.linear.x = speed


def waypoint_messages(lane: Waypoints, header: Any) -> list[Any]:
    """Return a lane as messages."""
    found = []
    for number in range(len(lane)):
        waypoint = Waypoint(gid=number, lid=number)
        waypoint.pose = pose_message(
            Place(float(lane.x_m[number]), float(lane.y_m[number]), float(lane.yaw_rad[number])),
            header,
        )
        waypoint.twist = TwistStamped(header=header)
        waypoint.twist.twist.linear.x = float(lane.speed_m_s[number])
        found.append(waypoint)
    return found


def place_of(pose: Any) -> Place:
    """Return a geometry_msgs/msg/Pose that is upright."""
    turn = pose.orientation
    return Place(pose.position.x, pose.position.y, 2.0 * math.atan2(turn.z, turn.w))


def pose_message(place: Place, header: Any) -> Any:
    """Return an upright pose at z = 0."""
    message = PoseStamped(header=header)
    message.pose.position.x, message.pose.position.y = place.x_m, place.y_m
    message.pose.orientation.z = math.sin(0.5 * place.yaw_rad)
    message.pose.orientation.w = math.cos(0.5 * place.yaw_rad)
    return message


def bytes_field(values: NDArray[np.uint8]) -> array[int]:
    """Return values that a field uint8[] takes without checking each element."""
    return array("B", values.tobytes())


def floats_field(values: NDArray[np.float32]) -> array[float]:
    """Return values that a field float32[] takes without checking each element."""
    return array("f", values.tobytes())


def pairs_of(message: Any) -> tuple[NDArray[np.uint8], NDArray[np.float32]]:
    """Return counts (N,) and pairs (P, 12) of a manycore_ros_lite_msgs/msg/Pairs.

    :raises ValueError: if the floats are no whole pairs.
    """
    counts = np.frombuffer(message.counts, np.uint8)
    return counts, np.frombuffer(message.pairs, np.float32).reshape(-1, 12)
