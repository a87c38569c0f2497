# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A drive along the synthetic street, and the map that an earlier drive has made."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np

from rmw_manycore_py.ndt.geometry.arrays import Matrix, Points
from rmw_manycore_py.ndt.geometry.poses import from_xyz_rpy
from rmw_manycore_py.ndt.recordings.recording import DEFAULT_PERIOD_S, Recording
from rmw_manycore_py.ndt.simulation.lidar import Lidar
from rmw_manycore_py.ndt.simulation.street import Street

SENSOR_HEIGHT_M = 1.9
WEAVE_M = 0.8  # to both sides of the middle of the road
WEAVE_PERIOD_M = 45.0
MAPPING_STEP_M = 4.0


def poses_along(distances_m: Iterable[float], side_m: float = 0.0) -> Matrix:
    """Return T_map_sensor (S, 4, 4) at distances along a weaving path, `side_m` left of it."""
    return np.stack([_pose_at(float(distance), side_m) for distance in distances_m])


def _pose_at(x: float, side_m: float) -> Matrix:
    phase = 2.0 * np.pi * x / WEAVE_PERIOD_M
    y = side_m + WEAVE_M * np.sin(phase)
    yaw = np.arctan(WEAVE_M * 2.0 * np.pi / WEAVE_PERIOD_M * np.cos(phase))
    pitch, roll = 0.005 * np.sin(1.7 * phase), 0.01 * np.sin(2.3 * phase)
    return from_xyz_rpy((x, y, SENSOR_HEIGHT_M), (roll, pitch, yaw))


def scans_along(
    street: Street, poses: Matrix, lidar: Lidar, generator: np.random.Generator
) -> Iterator[Points]:
    """Yield what the LiDAR sees from each pose."""
    for pose in poses:
        yield lidar.scan(street, pose, generator)


def drive_poses(length_m: float, speed_m_s: float) -> tuple[Matrix, Matrix]:
    """Return T_map_sensor and stamps of a drive with ten scans a second."""
    count = max(2, int(length_m / (speed_m_s * DEFAULT_PERIOD_S)))
    stamps: Matrix = np.arange(count, dtype=np.float64) * DEFAULT_PERIOD_S
    return poses_along(stamps * speed_m_s), stamps


def mapping_poses(length_m: float) -> Matrix:
    """Return where the mapping vehicle scanned: the other lane, and past both ends."""
    return poses_along(np.arange(-8.0, length_m + 8.0, MAPPING_STEP_M), side_m=0.6)


def record(scans: list[Points], poses: Matrix, stamps: Matrix, seed: int) -> Recording:
    """Return the drive as a recording."""
    return Recording(scans, poses, stamps, f"synthetic street, seed {seed}")
