# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A town of 500 m by 500 m: streets in both directions, and its map as a survey has it."""

from __future__ import annotations

from functools import cache

import numpy as np

from rmw_manycore_py.ndt.geometry.arrays import Matrix, Points
from rmw_manycore_py.ndt.geometry.poses import from_xyz_rpy
from rmw_manycore_py.ndt.simulation.drive import SENSOR_HEIGHT_M
from rmw_manycore_py.ndt.simulation.lidar import Lidar
from rmw_manycore_py.ndt.simulation.street import KERB_M, Street, build_street

SIDE_M, BLOCK_M = 500.0, 70.0
LIDAR = Lidar(rings=32, azimuths=400)
SPACING_M, NOISE_M = 0.5, 0.02  # of the map's points
ROAD_M = KERB_M + 1.0  # half of what is free of houses


def axes() -> Matrix:
    """Return the coordinates of the streets' middles, the same in x and y."""
    first: Matrix = np.arange(0.5 * (SIDE_M % BLOCK_M), SIDE_M, BLOCK_M)
    return first


@cache
def build_town(seed: int) -> Street:
    """Return streets along x and y whose crossings are free."""
    generator = np.random.default_rng(seed)
    parts = []
    for turned in (False, True):
        for middle in axes():
            street = build_street(SIDE_M - 80.0, generator)
            parts.append(_placed(street, middle, turned))
    joined = [np.concatenate(arrays) for arrays in zip(*parts, strict=True)]
    return Street(*joined)


def _placed(street: Street, middle: float, turned: bool) -> tuple[Matrix, ...]:
    """Return a street's arrays at its place, without what stands on the streets that it crosses."""
    shift = np.array([40.0, middle, 0.0])
    lower, upper, centres = street.lower + shift, street.upper + shift, street.centres + shift[:2]
    across = axes()[:, None]
    is_clear = (lower[:, 0] > across + ROAD_M) | (upper[:, 0] < across - ROAD_M)
    boxes = is_clear.all(axis=0)
    uprights = (np.abs(centres[:, 0] - across) > ROAD_M).all(axis=0)
    order = [1, 0, 2] if turned else [0, 1, 2]
    return (
        lower[boxes][:, order],
        upper[boxes][:, order],
        centres[uprights][:, order[:2]],
        street.radii[uprights],
        street.heights[uprights],
    )


def survey(town: Street, seed: int) -> Points:
    """Return points (N, 3) of the ground and of all walls, roofs, poles and trees."""
    generator = np.random.default_rng(seed)
    clouds = [_ground(town)]
    for low, high in zip(town.lower, town.upper, strict=True):
        clouds += _faces(low, high)
    for centre, radius, height in zip(town.centres, town.radii, town.heights, strict=True):
        angle, z = _grid(2 * np.pi, height, min(1.0, SPACING_M / radius), 0.2)
        at = [centre[0] + radius * np.cos(angle), centre[1] + radius * np.sin(angle), z]
        clouds.append(np.stack(at, axis=1))
    points = np.concatenate(clouds)
    return (points + generator.normal(0.0, NOISE_M, points.shape)).astype(np.float32)


def _grid(width: float, height: float, step: float, other_step: float) -> tuple[Matrix, Matrix]:
    u, v = np.meshgrid(np.arange(0.0, width, step), np.arange(0.0, height, other_step))
    return u.ravel(), v.ravel()


def _ground(town: Street) -> Matrix:
    x, y = _grid(SIDE_M, SIDE_M, SPACING_M, SPACING_M)
    covered = np.zeros(len(x), bool).reshape(int(SIDE_M / SPACING_M), -1)
    for low, high in zip(town.lower, town.upper, strict=True):
        first, last = (np.ceil(one / SPACING_M).astype(int).clip(0) for one in (low, high))
        covered[first[1] : last[1], first[0] : last[0]] = True
    free = ~covered.ravel()
    return np.stack([x[free], y[free], np.zeros(int(free.sum()))], axis=1)


def _faces(low: Matrix, high: Matrix) -> list[Matrix]:
    size = high - low
    faces = []
    for axis, sides in ((0, (0.0, size[0])), (1, (0.0, size[1])), (2, (size[2],))):
        others = [one for one in range(3) if one != axis]
        u, v = _grid(size[others[0]], size[others[1]], SPACING_M, SPACING_M)
        for side in sides:
            face = np.zeros((len(u), 3))
            face[:, axis], face[:, others[0]], face[:, others[1]] = side, u, v
            faces.append(face + low)
    return faces


def places(count: int, generator: np.random.Generator) -> Matrix:
    """Return poses (count, 4, 4) of a sensor on the streets, in any direction."""
    along = generator.uniform(20.0, SIDE_M - 20.0, count)
    across = generator.choice(axes(), count) + generator.uniform(-1.5, 1.5, count)
    turned = generator.random(count) < 0.5
    x, y = np.where(turned, across, along), np.where(turned, along, across)
    tilts = generator.normal(0.0, 0.01, (count, 2))
    yaws = generator.uniform(-np.pi, np.pi, count)
    return np.stack(
        [
            from_xyz_rpy((x[i], y[i], SENSOR_HEIGHT_M), (tilts[i, 0], tilts[i, 1], yaws[i]))
            for i in range(count)
        ]
    )
