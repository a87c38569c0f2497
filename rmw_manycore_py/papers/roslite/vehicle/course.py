# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A lane along the synthetic street, and the map of that street."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from rmw_manycore_py.ndt.geometry.arrays import Matrix
from rmw_manycore_py.ndt.geometry.poses import from_xyz_rpy
from rmw_manycore_py.ndt.geometry.thinning import voxel_centroids
from rmw_manycore_py.ndt.maps.map_file import write_points
from rmw_manycore_py.ndt.simulation.lidar import Lidar
from rmw_manycore_py.ndt.simulation.street import Street, build_street
from rmw_manycore_py.papers.roslite.laws.lanes import Place, Waypoints

MAP_FILE = "map.npz"
SENSOR_HEIGHT_M = 1.9
SWING_M, SWING_PERIOD_M = 0.5, 45.0
SPEED_M_S = 3.0  # slow mobility, as in the paper: 11 km/h
MAPPING_STEP_M = 4.0
MAP_LEAF_M = 0.15
MARGIN_M = 20.0  # of the map beyond both ends
LIDAR = Lidar(rings=24, azimuths=450)
_SEED = 11


@dataclass(frozen=True)
class Course:
    """A swinging lane of a length and a number of waypoints."""

    length_m: float
    waypoints: int

    def lane(self) -> Waypoints:
        """Return the waypoints, with the speed that waypoint_loader gives them."""
        x_m = np.linspace(0.0, self.length_m, self.waypoints)
        y_m, yaw_rad = swing(x_m)
        return Waypoints(x_m, y_m, yaw_rad, np.full(self.waypoints, SPEED_M_S))

    def start(self) -> Place:
        """Return where the vehicle stands at first."""
        _, yaw_rad = swing(np.zeros(1))
        return Place(0.0, 0.0, float(yaw_rad[0]))

    def street(self) -> Street:
        """Return the surroundings, the same each time."""
        return build_street(self.length_m, np.random.default_rng(_SEED))

    def write_map(self, directory: Path) -> Path:
        """Write the map of an earlier drive, points in the map frame; return its path."""
        street, generator = self.street(), np.random.default_rng(_SEED + 1)
        clouds = []
        for x_m in np.arange(-MARGIN_M, self.length_m + MARGIN_M, MAPPING_STEP_M):
            pose = sensor_pose(Place(float(x_m), 0.6, 0.0))
            scan = LIDAR.scan(street, pose, generator)
            clouds.append(scan @ pose[:3, :3].T + pose[:3, 3])
        path = directory / MAP_FILE
        write_points(path, voxel_centroids(np.concatenate(clouds), (MAP_LEAF_M,) * 3))
        return path


def swing(x_m: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return y and heading of the lane at x."""
    phase = 2.0 * np.pi * x_m / SWING_PERIOD_M
    slope = SWING_M * 2.0 * np.pi / SWING_PERIOD_M * np.cos(phase)
    return SWING_M * np.sin(phase), np.arctan(slope)


def sensor_pose(place: Place) -> Matrix:
    """Return T_map_sensor (4, 4) of a vehicle at a place."""
    return from_xyz_rpy((place.x_m, place.y_m, SENSOR_HEIGHT_M), (0.0, 0.0, place.yaw_rad))
