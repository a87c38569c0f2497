# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A drive along the synthetic street, and the map that an earlier drive has made."""

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
WEAVE_M = 0.8  # to both sides of the middle of the road
WEAVE_PERIOD_M = 45.0
MAPPING_STEP_M = 4.0
SWEEP_PARTS = 36  # in each of which the vehicle stands: 2 cm of way at 8 m/s


def poses_along(distances_m: Iterable[float], side_m: float = 0.0) -> Matrix:
    """Return T_map_sensor (S, 4, 4) at distances along a weaving path, `side_m` left of it."""
    return np.stack([_pose_at(float(distance), side_m) for distance in distances_m])


def _pose_at(x: float, side_m: float) -> Matrix:
    phase = 2.0 * np.pi * x / WEAVE_PERIOD_M
    y = side_m + WEAVE_M * np.sin(phase)
    yaw = np.arctan(WEAVE_M * 2.0 * np.pi / WEAVE_PERIOD_M * np.cos(phase))
    pitch, roll = 0.005 * np.sin(1.7 * phase), 0.01 * np.sin(2.3 * phase)
    return from_xyz_rpy((x, y, SENSOR_HEIGHT_M), (roll, pitch, yaw))


@dataclass(frozen=True)
class Surroundings:
    """What a drive is recorded with and in.

    :param traffic: cars that drive along, None for an empty road.
    :param speed_m_s: where the vehicle moves while a scan is taken; None: it stands meanwhile.
    """

    street: Street
    lidar: Lidar
    traffic: Traffic | None = None
    speed_m_s: float | None = None

    def scan(self, pose: Matrix, time_s: float, generator: np.random.Generator) -> Sweep:
        """Return what the LiDAR sees from a pose (4, 4) on, at a time of the drive."""
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
    """Points (n, 3) in the sensor frame of their moments; `times_s` (n) after the stamp, if any."""

    points: Points
    times_s: Matrix | None


def scans_along(
    street: Street, poses: Matrix, lidar: Lidar, generator: np.random.Generator
) -> Iterator[Points]:
    """Yield what the LiDAR sees from each pose."""
    for pose in poses:
        yield lidar.scan(street, pose, generator)


def sweeps_along(
    surroundings: Surroundings, poses: Matrix, stamps: Matrix, generator: np.random.Generator
) -> Iterator[Sweep]:
    """Yield the scans of a drive."""
    for pose, stamp_s in zip(poses, stamps, strict=True):
        yield surroundings.scan(pose, float(stamp_s), generator)


def drive_poses(length_m: float, speed_m_s: float) -> tuple[Matrix, Matrix]:
    """Return T_map_sensor and stamps of a drive with ten scans a second."""
    count = max(2, int(length_m / (speed_m_s * DEFAULT_PERIOD_S)))
    stamps: Matrix = np.arange(count, dtype=np.float64) * DEFAULT_PERIOD_S
    return poses_along(stamps * speed_m_s), stamps


def mapping_poses(length_m: float) -> Matrix:
    """Return where the mapping vehicle scanned: the other lane, and past both ends."""
    return poses_along(np.arange(-8.0, length_m + 8.0, MAPPING_STEP_M), side_m=0.6)


def record(sweeps: Sequence[Sweep], poses: Matrix, stamps: Matrix, note: str) -> Recording:
    """Return the drive as a recording."""
    times = [sweep.times_s for sweep in sweeps if sweep.times_s is not None]
    return Recording([sweep.points for sweep in sweeps], poses, stamps, note, times or None)
