# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Transforms of a bag (`/tf`, `/tf_static`): mounting and motion of a sensor."""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

import numpy as np

from rmw_manycore_py.ndt.geometry import poses
from rmw_manycore_py.ndt.geometry.arrays import Matrix
from rmw_manycore_py.ndt.recordings.pose_file import PoseLine

TYPES = {"tf2_msgs/msg/TFMessage", "tf/msg/tfMessage"}
TOPICS = ("tf", "tf_static")  # possibly in a namespace
LONGEST_CHAIN = 100


@dataclass
class Joint:
    """T_parent_child at increasing times in seconds."""

    parent: str
    stamps: list[float] = field(default_factory=list)
    transforms: list[Matrix] = field(default_factory=list)

    @property
    def is_fixed(self) -> bool:
        """Return whether it never moves, as of sensors whose mounting is published repeatedly."""
        return all(np.array_equal(T, self.transforms[0]) for T in self.transforms)

    def line(self) -> PoseLine:
        """Return the transforms as poses."""
        return PoseLine(np.array(self.transforms), np.array(self.stamps))


class Transforms:
    """Tree of frames; a frame keeps its first parent."""

    def __init__(self, reader: Any) -> None:
        from rmw_manycore_py.ndt.messages.conversions import seconds

        self._joints: dict[str, Joint] = {}
        found = [one for one in reader.connections if is_transforms(one)]
        for connection, at_ns, data in reader.messages(found) if found else ():
            for transform in reader.deserialize(data, connection.msgtype).transforms:
                self._add(transform, seconds(transform.header.stamp) or 1e-9 * at_ns)

    def _add(self, message: Any, stamp_s: float) -> None:
        """Add a transform; skip invalid ones."""
        from rmw_manycore_py.ndt.messages.conversions import PoseError, matrix_of_transform

        try:
            T_parent_child = matrix_of_transform(message.transform)
        except PoseError:
            return
        parent, child = (
            name.lstrip("/") for name in (message.header.frame_id, message.child_frame_id)
        )
        joint = self._joints.setdefault(child, Joint(parent))
        if joint.parent == parent and (not joint.stamps or stamp_s > joint.stamps[-1]):
            joint.stamps.append(stamp_s)
            joint.transforms.append(T_parent_child)

    def mounting(self, base: str, sensor: str) -> Matrix | None:
        """Return T_base_sensor over fixed joints; None if they do not connect the frames."""
        up_sensor, up_base = self._fixed_above(sensor), self._fixed_above(base)
        for frame, T_frame_sensor in up_sensor.items():
            if frame in up_base:
                T_base_sensor: Matrix = poses.inverse(up_base[frame]) @ T_frame_sensor
                return T_base_sensor
        return None

    def motion(self, sensor: str) -> PoseLine | None:
        """Return the poses of a frame in its root frame; None if nothing above it moves.

        They have the stamps of the joint published most often; other joints are interpolated, and
        stamps at which one is unknown are dropped.
        """
        joints = [self._joints[frame] for frame in self._above(sensor)[:-1]]
        moving = [joint.line() for joint in joints if not joint.is_fixed]
        if not moving:
            return None
        stamps = max((line.stamps for line in moving), key=len)
        for line in moving:
            stamps = stamps[line.at(stamps)[0]]
        T = np.tile(np.eye(4), (len(stamps), 1, 1))
        for joint in joints:  # from the sensor to the root
            T = (joint.transforms[0] if joint.is_fixed else joint.line().at(stamps)[1]) @ T
        return PoseLine(T, stamps)

    def _above(self, frame: str) -> list[str]:
        """Return the frame and its ancestors, root last."""
        chain = [frame.lstrip("/")]
        while (joint := self._joints.get(chain[-1])) and len(chain) < LONGEST_CHAIN:
            if joint.parent in chain:
                break
            chain.append(joint.parent)
        return chain

    def _fixed_above(self, frame: str) -> dict[str, Matrix]:
        """Return T_ancestor_frame of the frame itself and the frames it is fixed to."""
        chain = self._above(frame)
        above = {chain[0]: np.eye(4)}
        for child, parent in pairwise(chain):
            joint = self._joints[child]
            if not joint.is_fixed:
                break
            above[parent] = joint.transforms[0] @ above[child]
        return above


def is_transforms(connection: Any) -> bool:
    """Return whether a connection of a bag carries transforms."""
    return connection.msgtype in TYPES and connection.topic.rpartition("/")[2] in TOPICS
