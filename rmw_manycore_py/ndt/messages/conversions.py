# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Conversions of poses between ROS messages and matrices."""

from __future__ import annotations

from typing import Any

import numpy as np
from builtin_interfaces.msg import Time
from geometry_msgs.msg import (
    Pose,
    PoseStamped,
    PoseWithCovarianceStamped,
    Quaternion,
    Transform,
    TransformStamped,
    Vector3,
)

from rmw_manycore_py.ndt.geometry import poses
from rmw_manycore_py.ndt.geometry.arrays import Matrix

FARTHEST_M = 1e7  # larger coordinates are treated as errors
SMALLEST_NORM = 1e-3


class PoseError(ValueError):
    """A pose that is not finite, too far away, or has a zero quaternion."""


def matrix_of(pose: Any) -> Matrix:
    """Return the matrix of a geometry_msgs/msg/Pose; raises PoseError."""
    p, q = pose.position, pose.orientation
    return _checked(np.array([p.x, p.y, p.z]), np.array([q.x, q.y, q.z, q.w]))


def matrix_of_transform(transform: Any) -> Matrix:
    """Return the matrix of a geometry_msgs/msg/Transform; raises PoseError."""
    p, q = transform.translation, transform.rotation
    return _checked(np.array([p.x, p.y, p.z]), np.array([q.x, q.y, q.z, q.w]))


def _checked(position: Matrix, quaternion: Matrix) -> Matrix:
    if not (np.isfinite(position).all() and np.isfinite(quaternion).all()):
        raise PoseError("the pose is not finite")
    if np.abs(position).max() > FARTHEST_M:
        raise PoseError(f"the position is farther than {FARTHEST_M:g} m from the origin")
    if np.linalg.norm(quaternion) < SMALLEST_NORM:
        raise PoseError("the quaternion of the pose is zero")
    T = np.eye(4)
    T[:3, :3] = poses.from_quaternion(quaternion)
    T[:3, 3] = position
    return T


def pose_of(T: Matrix) -> Any:
    """Return a geometry_msgs/msg/Pose."""
    pose = Pose(orientation=_quaternion(T))
    pose.position.x, pose.position.y, pose.position.z = (float(v) for v in T[:3, 3])
    return pose


def pose_stamped(T: Matrix, stamp: Any, frame_id: str) -> Any:
    """Return a geometry_msgs/msg/PoseStamped."""
    message = PoseStamped(pose=pose_of(T))
    message.header.stamp = stamp
    message.header.frame_id = frame_id
    return message


def pose_with_covariance(T: Matrix, covariance: Matrix, stamp: Any, frame_id: str) -> Any:
    """Return a geometry_msgs/msg/PoseWithCovarianceStamped; covariance (6, 6)."""
    message = PoseWithCovarianceStamped()
    message.header.stamp = stamp
    message.header.frame_id = frame_id
    message.pose.pose = pose_of(T)
    message.pose.covariance = covariance.ravel()
    return message


def transform_stamped(T: Matrix, stamp: Any, frame_id: str, child_frame_id: str) -> Any:
    """Return a geometry_msgs/msg/TransformStamped of T_frame_child."""
    x, y, z = (float(value) for value in T[:3, 3])
    transform = Transform(translation=Vector3(x=x, y=y, z=z), rotation=_quaternion(T))
    message = TransformStamped(child_frame_id=child_frame_id, transform=transform)
    message.header.stamp = stamp
    message.header.frame_id = frame_id
    return message


def covariance_of(message: Any) -> Matrix:
    """Return the covariance (6, 6) of a PoseWithCovarianceStamped."""
    return np.asarray(message.pose.covariance, dtype=np.float64).reshape(6, 6)


def seconds(stamp: Any) -> float:
    """Convert a builtin_interfaces/msg/Time to seconds."""
    return float(stamp.sec) + 1e-9 * float(stamp.nanosec)


def nanoseconds(stamp: Any) -> int:
    """Convert a builtin_interfaces/msg/Time to nanoseconds."""
    return int(stamp.sec) * 1_000_000_000 + int(stamp.nanosec)


def stamp_of(time_ns: int) -> Any:
    """Convert nanoseconds to a builtin_interfaces/msg/Time."""
    return Time(sec=time_ns // 1_000_000_000, nanosec=time_ns % 1_000_000_000)


def _quaternion(T: Matrix) -> Any:
    x, y, z, w = (float(value) for value in poses.to_quaternion(T[:3, :3]))
    return Quaternion(x=x, y=y, z=z, w=w)
