# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A drive along the synthetic street, and the map from an earlier drive."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from rmw_manycore_py.ndt.geometry.arrays import Matrix, Points
from rmw_manycore_py.ndt.geometry.poses import from_xyz_rpy
from rmw_manycore_py.ndt.recordings.recording import DEFAULT_PERIOD_S, Recording
from rmw_manycore_py.ndt.simulation.lidar import Lidar
from rmw_manycore_py.ndt.simulation.street import Street
from rmw_manycore_py.ndt.simulation.traffic import Traffic

SENSOR_HEIGHT_M = 1.9
WEAVE_M = 0.8  # amplitude around the centre of the road
WEAVE_PERIOD_M = 45.0
MAPPING_STEP_M = 4.0
SWEEP_PARTS = 36  # per scan, each with a constant pose: 2 cm at 8 m/s


def poses_along(distances_m: Iterable[float], side_m: float = 0.0) -> Matrix:
    """Return T_map_sensor (S, 4, 4) at distances along a weaving path, offset `side_m` left."""
    return np.stack([_pose_at(float(distance), side_m) for distance in distances_m])


def _pose_at(x: float, side_m: float) -> Matrix:
    phase = 2.0 * np.pi * x / WEAVE_PERIOD_M
    y = side_m + WEAVE_M * np.sin(phase)
    yaw = np.arctan(WEAVE_M * 2.0 * np.pi / WEAVE_PERIOD_M * np.cos(phase))
    pitch, roll = 0.005 * np.sin(1.7 * phase), 0.01 * np.sin(2.3 * phase)
    return from_xyz_rpy((x, y, SENSOR_HEIGHT_M), (roll, pitch, yaw))


@dataclass(frozen=True)
class Surroundings:
    """Sensor and environment of a drive.

    :param traffic: moving cars; None for an empty road.
    :param speed_m_s: speed during a scan; None for a stationary sensor.
    """

    street: Street
    lidar: Lidar
    traffic: Traffic | None = None
    speed_m_s: float | None = None

    def scan(self, pose: Matrix, time_s: float, generator: np.random.Generator) -> Sweep:
        """Return the LiDAR's scan starting at a pose (4, 4) and a time of the drive."""
        if self.speed_m_s is None:
            street = self._with_traffic(float(pose[0, 3]), time_s)
            return Sweep(self.lidar.scan(street, pose, generator), None)
        clouds, times = [], []
        azimuth = self.lidar.azimuth_rad()
        for part in np.array_split(azimuth, min(SWEEP_PARTS, len(azimuth))):
            after_s = DEFAULT_PERIOD_S * float(np.mean(part) + np.pi) / (2.0 * np.pi)
            x = self.speed_m_s * (time_s + after_s)
            street = self._with_traffic(x, time_s + after_s)
            clouds.append(self.lidar.scan(street, _pose_at(x, 0.0), generator, part))
            times.append(np.full(len(clouds[-1]), after_s))
        return Sweep(np.concatenate(clouds), np.concatenate(times))

    def _with_traffic(self, x: float, time_s: float) -> Street:
        if self.traffic is None:
            return self.street
        return self.traffic.in_street(self.street, x, time_s)


@dataclass(frozen=True)
class Sweep:
    """Points (n, 3), each in the sensor frame of its time; `times_s` (n) after the stamp."""

    points: Points
    times_s: Matrix | None


def scans_along(
    street: Street, poses: Matrix, lidar: Lidar, generator: np.random.Generator
) -> Iterator[Points]:
    """Yield the LiDAR's scan at each pose."""
    for pose in poses:
        yield lidar.scan(street, pose, generator)


def sweeps_along(
    surroundings: Surroundings, poses: Matrix, stamps: Matrix, generator: np.random.Generator
) -> Iterator[Sweep]:
    """Yield the scans of a drive."""
    for pose, stamp_s in zip(poses, stamps, strict=True):
        yield surroundings.scan(pose, float(stamp_s), generator)


def drive_poses(length_m: float, speed_m_s: float) -> tuple[Matrix, Matrix]:
    """Return T_map_sensor and stamps of a drive with ten scans per second."""
    count = max(2, int(length_m / (speed_m_s * DEFAULT_PERIOD_S)))
    stamps: Matrix = np.arange(count, dtype=np.float64) * DEFAULT_PERIOD_S
    return poses_along(stamps * speed_m_s), stamps


def mapping_poses(length_m: float) -> Matrix:
    """Return the mapping vehicle's scan poses: on the other lane, and beyond both ends."""
    return poses_along(np.arange(-8.0, length_m + 8.0, MAPPING_STEP_M), side_m=0.6)


def record(sweeps: Sequence[Sweep], poses: Matrix, stamps: Matrix, note: str) -> Recording:
    """Return the drive as a recording."""
    times = [sweep.times_s for sweep in sweeps if sweep.times_s is not None]
    return Recording([sweep.points for sweep in sweeps], poses, stamps, note, times or None)
