# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Alignment of sensors whose x axis points up or down in the map, such as optical frames.

There roll and yaw rotate about the same axis (gimbal lock), and steps in angles fail. So the scan
is rotated to a frame parallel to the map's at the guess, aligned, and the result rotated back.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rmw_manycore_py.ndt.geometry.arrays import Pose, ScanPoints

STEEP = np.sin(np.radians(60.0))


@dataclass(frozen=True)
class Levelled:
    """A scan in a level frame, and the guess of that frame.

    :param T_level_sensor: (4, 4) from the sensor's own frame.
    """

    points: ScanPoints
    guess: Pose
    T_level_sensor: Pose

    def result(self, T_map_level: Pose) -> Pose:
        """Return T_map_sensor (4, 4), or (n, 4, 4) for several."""
        T_map_sensor: Pose = T_map_level @ self.T_level_sensor
        return T_map_sensor


def levelled(points: ScanPoints, guess: Pose) -> Levelled:
    """Return points (N, 3) and guess (4, 4), unchanged unless the sensor looks up or down."""
    T_level_sensor = np.eye(4)
    if abs(guess[0, 2]) < STEEP:
        return Levelled(points, guess, T_level_sensor)
    T_level_sensor[:3, :3] = guess[:3, :3]
    level = np.eye(4)
    level[:3, 3] = guess[:3, 3]
    with np.errstate(invalid="ignore", over="ignore"):  # non-finite points
        turned = (points @ T_level_sensor[:3, :3].T).astype(np.float32)
    return Levelled(np.ascontiguousarray(turned), level, T_level_sensor)
