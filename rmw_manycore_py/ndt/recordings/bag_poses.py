# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Reference poses of a bag, from a topic or `/tf`, transformed to the LiDAR frame."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.ndt.geometry.arrays import Matrix
from rmw_manycore_py.ndt.recordings.connections import connections_of
from rmw_manycore_py.ndt.recordings.pose_file import PoseLine
from rmw_manycore_py.ndt.recordings.transforms import Transforms, is_transforms

POSE_PATHS = {  # path to the pose in a message
    "nav_msgs/msg/Odometry": ("pose", "pose"),
    "geometry_msgs/msg/PoseStamped": ("pose",),
    "geometry_msgs/msg/PoseWithCovarianceStamped": ("pose", "pose"),
    "geometry_msgs/msg/TransformStamped": ("transform",),
}
BASE = "base_link"  # default child frame (REP 105)


def poses_of(path: Path, reader: Any, topic: str, lidar: str) -> tuple[PoseLine, str]:
    """Return the poses of the LiDAR, and a remark about them ("" if there is none)."""
    transforms = Transforms(reader)
    is_transforms_named = any(
        one.topic == topic for one in reader.connections if is_transforms(one)
    )
    has_poses = any(one.msgtype in POSE_PATHS for one in reader.connections)
    if is_transforms_named or not (topic or has_poses):
        line = transforms.motion(lidar)
        if line is None or not len(line.stamps):
            raise ManycoreError(
                f"{path}: expected a topic of the type {' or '.join(sorted(POSE_PATHS))}, or /tf "
                f"with the motion of '{lidar}', found neither: name poses with --pose-topic, or a "
                "file with --poses",
                EXIT_BAD_INPUT,
            )
        return line, "poses are those of /tf"
    line, base = _of_topic(path, reader, topic)
    T_base_lidar = transforms.mounting(base, lidar)
    if T_base_lidar is None:
        return line, f"no transform connects '{base}' and '{lidar}': taken for the same"
    return PoseLine(line.poses @ T_base_lidar, line.stamps), ""


def _of_topic(path: Path, reader: Any, topic: str) -> tuple[PoseLine, str]:
    """Return the poses of a topic, and their child frame."""
    from rmw_manycore_py.ndt.messages.conversions import PoseError, seconds

    kinds = set(POSE_PATHS)
    connections = connections_of(path, reader, kinds, topic, "--pose-topic, or a file with --poses")
    stamps: list[float] = []
    found: list[Matrix] = []
    base = BASE
    for connection, at_ns, data in reader.messages(connections):
        message = reader.deserialize(data, connection.msgtype)
        base = getattr(message, "child_frame_id", "") or BASE
        try:
            found.append(_matrix(message, connection.msgtype))
        except PoseError as error:
            raise ManycoreError(f"{path}: {connection.topic}: {error}", EXIT_BAD_INPUT) from error
        stamps.append(seconds(message.header.stamp) or 1e-9 * at_ns)
    return PoseLine(np.array(found).reshape(-1, 4, 4), np.array(stamps)), base


def _matrix(message: Any, kind: str) -> Matrix:
    from rmw_manycore_py.ndt.messages.conversions import matrix_of, matrix_of_transform

    for name in POSE_PATHS[kind]:
        message = getattr(message, name)
    return matrix_of_transform(message) if kind.endswith("TransformStamped") else matrix_of(message)
