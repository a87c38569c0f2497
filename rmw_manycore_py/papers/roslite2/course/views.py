# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""LiDAR views of the surroundings: of streets, or of a point map."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
import numpy.typing as npt

from rmw_manycore_py.ndt.geometry.arrays import Matrix, Points
from rmw_manycore_py.ndt.geometry.poses import from_xyz_rpy, inverse, transform
from rmw_manycore_py.ndt.simulation.lidar import Lidar
from rmw_manycore_py.ndt.simulation.street import Street
from rmw_manycore_py.papers.roslite2.course.streets import near

SENSOR_HEIGHT_M = 1.2  # above the ground, over the centre of the driven axle
LIDAR = Lidar(rings=16, azimuths=360, lowest_deg=-15.0, highest_deg=15.0, range_m=40.0)


class View(Protocol):
    """Surroundings as seen by the LiDAR."""

    def scan(
        self, x_m: float, y_m: float, yaw_rad: float, generator: np.random.Generator
    ) -> Points:
        """Return points (N, 3) in the vehicle's frame: x ahead, y left, z up from the ground."""


def _sensor_pose(x_m: float, y_m: float, yaw_rad: float) -> Matrix:
    return from_xyz_rpy((x_m, y_m, SENSOR_HEIGHT_M), (0.0, 0.0, yaw_rad))


def _above_ground(points: Points) -> Points:
    lifted: Points = points + np.array([0.0, 0.0, SENSOR_HEIGHT_M], points.dtype)
    return lifted


@dataclass(frozen=True)
class StreetView:
    """Casts rays into boxes, cylinders and the ground."""

    street: Street
    lidar: Lidar = LIDAR

    def scan(
        self, x_m: float, y_m: float, yaw_rad: float, generator: np.random.Generator
    ) -> Points:
        """Return the scan; see View."""
        street = near(self.street, x_m, y_m, self.lidar.range_m)
        pose = _sensor_pose(x_m, y_m, yaw_rad)
        return _above_ground(self.lidar.scan(street, pose, generator))


@dataclass(frozen=True)
class PointView:
    """Returns the nearest point of a map in the direction of each ray.

    Occlusion is only as good as the map is dense: a ray between two points hits the next surface.
    """

    points: Points
    lidar: Lidar = LIDAR

    def scan(
        self, x_m: float, y_m: float, yaw_rad: float, generator: np.random.Generator
    ) -> Points:
        """Return the scan; see View."""
        around = np.abs(self.points[:, :2] - (x_m, y_m)).max(axis=1) < self.lidar.range_m
        pose = _sensor_pose(x_m, y_m, yaw_rad)
        seen = transform(inverse(pose), self.points[around].astype(np.float64))
        ranges = np.linalg.norm(seen, axis=1)
        seen, ranges = seen[ranges > 0.5], ranges[ranges > 0.5]
        first = self._first_of_each_ray(seen, ranges)
        noise = 1.0 + generator.normal(0.0, self.lidar.noise_m, len(first)) / ranges[first]
        return _above_ground((seen[first] * noise[:, None]).astype(np.float32))

    def _first_of_each_ray(self, seen: Points, ranges: Points) -> npt.NDArray[np.intp]:
        lidar = self.lidar
        elevation = np.degrees(np.arcsin(seen[:, 2] / ranges))
        ring = (elevation - lidar.lowest_deg) / (lidar.highest_deg - lidar.lowest_deg)
        ring = np.rint(ring * (lidar.rings - 1)).astype(np.int64)
        azimuth = np.arctan2(seen[:, 1], seen[:, 0]) / (2.0 * np.pi) * lidar.azimuths
        ray = ring * lidar.azimuths + np.rint(azimuth).astype(np.int64) % lidar.azimuths
        is_seen = (ring >= 0) & (ring < lidar.rings) & (ranges < lidar.range_m)
        order = np.flatnonzero(is_seen)[np.argsort(ranges[is_seen], kind="stable")]
        _, nearest = np.unique(ray[order], return_index=True)
        first: npt.NDArray[np.intp] = order[nearest]
        return first
