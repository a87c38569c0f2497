# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Find where in a map a LiDAR scan was taken, from a guess that is a metre off.

    python examples/05_align_a_scan.py

Map and scan are made here: a street with walls and poles, seen from a pose that is known.
"""

import numpy as np
from numpy.typing import NDArray

from rmw_manycore_py import ndt

Points = NDArray[np.float64]


def street(generator: np.random.Generator) -> Points:
    """Return points (N, 3) [m, map frame]: ground, walls with gaps, poles; 2 cm of noise."""
    ground = generator.uniform([0, -8, 0], [80, 8, 0], (20_000, 3))
    walls = generator.uniform([0, 0, 0], [80, 0, 6], (20_000, 3))
    walls = walls[walls[:, 0] % 16 < 10]
    walls[:, 1] = np.where(walls[:, 0] % 32 < 16, -8, 8)
    poles = generator.uniform([0, 0, 0], [16, 0.2, 6], (4_000, 3))
    poles[:, 0] = 7 * poles[:, 0].round() % 80
    poles[:, 1] += np.where(poles[:, 0] % 2 < 1, -6, 6)
    points = np.concatenate([ground, walls, poles])
    return points + generator.normal(scale=0.02, size=points.shape)


def pose(x_m: float, y_m: float, yaw_rad: float) -> Points:
    """Return T_map_sensor (4, 4) of a sensor 2 m above the ground."""
    cosine, sine = np.cos(yaw_rad), np.sin(yaw_rad)
    T_map_sensor = np.eye(4)
    T_map_sensor[:2, :2] = [[cosine, -sine], [sine, cosine]]
    T_map_sensor[:3, 3] = x_m, y_m, 2.0
    return T_map_sensor


def main() -> None:
    """Align a scan and compare what was found with the truth."""
    generator = np.random.default_rng(1)
    map_points, truth = street(generator), pose(40.0, 1.0, 0.1)
    near = map_points[np.linalg.norm(map_points - truth[:3, 3], axis=1) < 25.0]
    scan = (near - truth[:3, 3]) @ truth[:3, :3]  # in the frame of the sensor

    result = ndt.align(map_points, scan[::5], pose(40.8, 0.4, 0.05))

    error_m = np.linalg.norm(result.T_map_sensor[:3, 3] - truth[:3, 3])
    print(f"converged: {result.converged} {result.why}".rstrip())
    print(f"score {result.score:.0f} after {result.iterations} steps")
    print(f"{100 * error_m:.1f} cm from the truth")
    print(result.T_map_sensor.round(3))


if __name__ == "__main__":
    main()
