# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The points of a scan that a search compares with the map: upright, above the ground."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rmw_manycore_py.ndt.geometry import poses
from rmw_manycore_py.ndt.geometry.arrays import Matrix, Pose, ScanPoints
from rmw_manycore_py.ndt.geometry.thinning import voxel_centroids

POINTS = 400
THINNED_M = 1.0  # so that near walls do not outweigh far ones
REACH_M = 60.0  # farther points are not used
ABOVE_GROUND_M = 1.0  # minimum height of a point: the ground fits everywhere
GROUND_FROM_M, GROUND_TO_M = 2.0, 15.0  # where the ground around the sensor is measured
GROUND_SHARE = 0.05  # of the points there that may be below it
FEWEST_POINTS = 20


@dataclass(frozen=True)
class Sketch:
    """Points of a scan in an upright frame at the sensor, whose yaw is that of the sensor.

    :param points: (n, 3) [m]; z is the height above the ground.
    :param upright: (3, 3) rotation from the sensor's frame.
    :param height_m: height of the sensor's frame above the ground.
    """

    points: ScanPoints
    upright: Matrix
    height_m: float

    @classmethod
    def of(cls, scan: ScanPoints, T_map_base: Pose) -> Sketch:
        """Choose points of a scan (N, 3), whose roll and pitch are those of a pose (4, 4)."""
        roll, pitch, _ = poses.to_rpy(T_map_base)
        upright = poses.from_xyz_rpy((0.0, 0.0, 0.0), (roll, pitch, 0.0))[:3, :3]
        points = scan[np.isfinite(scan).all(axis=1)].astype(np.float64) @ upright.T
        away_m = np.hypot(points[:, 0], points[:, 1])
        around = points[(away_m > GROUND_FROM_M) & (away_m < GROUND_TO_M), 2]
        ground_m = float(np.quantile(around, GROUND_SHARE)) if len(around) else 0.0
        points[:, 2] -= ground_m
        chosen = points[(points[:, 2] > ABOVE_GROUND_M) & (away_m < REACH_M)]
        if len(chosen):
            chosen = voxel_centroids(chosen, (THINNED_M,) * 3)
        order = np.random.default_rng(0).permutation(len(chosen))[:POINTS]
        return cls(np.ascontiguousarray(chosen[order], np.float32), upright, -ground_m)

    @property
    def is_enough(self) -> bool:
        """Return whether the points can tell places apart."""
        return len(self.points) >= FEWEST_POINTS

    def pose(self, x_m: float, y_m: float, ground_m: float, yaw_rad: float) -> Pose:
        """Return the sensor's pose at a place of the map."""
        T = poses.from_xyz_rpy((x_m, y_m, ground_m + self.height_m), (0.0, 0.0, yaw_rad))
        T[:3, :3] = T[:3, :3] @ self.upright
        return T
