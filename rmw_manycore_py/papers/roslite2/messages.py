# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Conversions of trajectories and poses between arrays and Autoware's messages."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from autoware_planning_msgs.msg import Trajectory as TrajectoryMessage
from autoware_planning_msgs.msg import TrajectoryPoint

from rmw_manycore_py.papers.roslite2.laws.following import PlanarPose
from rmw_manycore_py.papers.roslite2.laws.trajectory import Trajectory


def trajectory_message(trajectory: Trajectory, frame: str) -> Any:
    """Return an autoware_planning_msgs/msg/Trajectory without a stamp, at height 0."""
    message = TrajectoryMessage()
    message.header.frame_id = frame
    message.points = [_point(trajectory, index) for index in range(len(trajectory))]
    return message


def _point(trajectory: Trajectory, index: int) -> Any:
    pose = trajectory.pose(index)
    point = TrajectoryPoint(longitudinal_velocity_mps=trajectory.speed(index))
    point.pose.position.x, point.pose.position.y = pose.x_m, pose.y_m
    point.pose.orientation.z = math.sin(0.5 * pose.yaw_rad)
    point.pose.orientation.w = math.cos(0.5 * pose.yaw_rad)
    return point


def trajectory_of(message: Any) -> Trajectory:
    """Return the trajectory of a message."""
    rows = [
        (p.pose.position.x, p.pose.position.y, yaw_of(p.pose), p.longitudinal_velocity_mps)
        for p in message.points
    ]
    x, y, yaw, speed = np.array(rows, np.float64).reshape(-1, 4).T
    return Trajectory(x, y, yaw, speed)


def yaw_of(pose: Any) -> float:
    """Return the heading of a geometry_msgs/msg/Pose."""
    q = pose.orientation
    return math.atan2(2.0 * (q.w * q.z + q.x * q.y), 1.0 - 2.0 * (q.y * q.y + q.z * q.z))


def planar_pose(pose: Any) -> PlanarPose:
    """Return a geometry_msgs/msg/Pose in the plane."""
    return PlanarPose(pose.position.x, pose.position.y, yaw_of(pose))
