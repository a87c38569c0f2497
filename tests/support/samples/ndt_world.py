# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A street to match in: ground, two rows of houses with gaps, and poles."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Points = NDArray[np.float64]


def street(seed: int = 1, spacing_m: float = 0.25) -> Points:
    """Return points (N, 3) [m, map frame], 80 m along x, with 2 cm of noise."""
    rng = np.random.default_rng(seed)
    along, across = np.meshgrid(np.arange(0, 80, spacing_m), np.arange(-8, 8, spacing_m))
    ground = np.stack([along.ravel(), across.ravel(), np.zeros(along.size)], axis=1)
    walls = [ground]
    for side in (-8.0, 8.0):
        for begin in np.arange(0, 80, 16.0):
            x, z = np.meshgrid(np.arange(begin, begin + 10, spacing_m), np.arange(0, 6, spacing_m))
            walls.append(np.stack([x.ravel(), np.full(x.size, side), z.ravel()], axis=1))
            y, z = np.meshgrid(side * np.arange(1, 1.6, spacing_m / 8), np.arange(0, 6, spacing_m))
            walls.append(np.stack([np.full(y.size, begin + 10), y.ravel(), z.ravel()], axis=1))
    points = np.concatenate(walls)
    return points + rng.normal(scale=0.02, size=points.shape)


def scan_at(points: Points, T_map_sensor: Points, reach_m: float = 25.0) -> NDArray[np.float32]:
    """Return the points seen from a pose, in the sensor frame; every third point, new noise."""
    rng = np.random.default_rng(7)
    near = points[np.linalg.norm(points - T_map_sensor[:3, 3], axis=1) < reach_m][::3]
    seen = (near - T_map_sensor[:3, 3]) @ T_map_sensor[:3, :3]
    noisy: NDArray[np.float32] = (seen + rng.normal(scale=0.01, size=seen.shape)).astype(np.float32)
    return noisy


def pose(x: float, y: float, z: float, roll: float, pitch: float, yaw: float) -> Points:
    """Return T (4, 4) with R = Rx(roll) Ry(pitch) Rz(yaw), in metres and radians."""
    matrix = np.eye(4)
    cosines, sines = np.cos([roll, pitch, yaw]), np.sin([roll, pitch, yaw])
    turn_x = np.array([[1, 0, 0], [0, cosines[0], -sines[0]], [0, sines[0], cosines[0]]])
    turn_y = np.array([[cosines[1], 0, sines[1]], [0, 1, 0], [-sines[1], 0, cosines[1]]])
    turn_z = np.array([[cosines[2], -sines[2], 0], [sines[2], cosines[2], 0], [0, 0, 1]])
    matrix[:3, :3] = turn_x @ turn_y @ turn_z
    matrix[:3, 3] = (x, y, z)
    return matrix


def errors(found: Points, true: Points) -> tuple[float, float]:
    """Return the distance [m] and the angle [deg] between two poses."""
    turn = found[:3, :3].T @ true[:3, :3]
    angle = np.degrees(np.arccos(np.clip((np.trace(turn) - 1) / 2, -1, 1)))
    return float(np.linalg.norm(found[:3, 3] - true[:3, 3])), float(angle)
