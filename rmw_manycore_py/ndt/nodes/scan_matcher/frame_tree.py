# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Latest transforms of `/tf` and `/tf_static`, for the mounting of a sensor."""

from __future__ import annotations

from typing import Any

import numpy as np
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from tf2_msgs.msg import TFMessage

from rmw_manycore_py.ndt.geometry import poses
from rmw_manycore_py.ndt.geometry.arrays import Matrix
from rmw_manycore_py.ndt.messages.conversions import PoseError, matrix_of_transform

LONGEST_CHAIN = 100


class FrameError(LookupError):
    """Two frames are not connected by transforms."""


class FrameTree:
    """Tree of frames; stamps are ignored."""

    def __init__(self) -> None:
        self._parents: dict[str, tuple[str, Matrix]] = {}

    def listen(self, node: Node) -> None:
        """Subscribe to all transforms."""
        kept = QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        node.create_subscription(TFMessage, "/tf", self.add, QoSProfile(depth=100))
        node.create_subscription(TFMessage, "/tf_static", self.add, kept)

    def add(self, message: Any) -> None:
        """Add a tf2_msgs/msg/TFMessage; ignore invalid transforms."""
        for transform in message.transforms:
            try:
                T_parent_child = matrix_of_transform(transform.transform)
            except PoseError:
                continue
            child, parent = transform.child_frame_id, transform.header.frame_id
            self._parents[child.lstrip("/")] = (parent.lstrip("/"), T_parent_child)

    def lookup(self, target: str, source: str) -> Matrix:
        """Return T_target_source; raises FrameError."""
        up_source, up_target = self._to_root(source.lstrip("/")), self._to_root(target.lstrip("/"))
        for frame, T_frame_source in up_source.items():
            if frame in up_target:
                return poses.inverse(up_target[frame]) @ T_frame_source
        raise FrameError(f"no transform connects '{source}' and '{target}'")

    def _to_root(self, frame: str) -> dict[str, Matrix]:
        """Return T_ancestor_frame of the frame and all its ancestors, nearest first."""
        chain = {frame: np.eye(4)}
        while frame in self._parents and len(chain) < LONGEST_CHAIN:
            parent, T_parent_child = self._parents[frame]
            if parent in chain:
                break
            chain[parent] = T_parent_child @ chain[frame]
            frame = parent
        return chain
