# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Simulates a spinning LiDAR: one ray per ring and azimuth, nearest hit."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from rmw_manycore_py.ndt.geometry.arrays import Matrix, Points
from rmw_manycore_py.ndt.simulation.street import Street


@dataclass(frozen=True)
class Lidar:
    """Properties of the sensor; the defaults are those of a common LiDAR with 32 rings.

    :param hidden_share: fraction of azimuths hidden by the vehicle, at the rear.
    """

    rings: int = 32
    azimuths: int = 600
    lowest_deg: float = -25.0
    highest_deg: float = 15.0
    range_m: float = 60.0
    noise_m: float = 0.02
    hidden_share: float = 0.0

    def azimuth_rad(self) -> Matrix:
        """Return the visible azimuths (n,), in measurement order."""
        azimuth: Matrix = np.linspace(-np.pi, np.pi, self.azimuths, endpoint=False)
        return azimuth[np.abs(azimuth) <= np.pi * (1.0 - self.hidden_share)]

    def directions(self, azimuth: Matrix | None = None) -> Matrix:
        """Return unit vectors (rings * n, 3) in the sensor frame, for all or some azimuths (n,)."""
        elevation = np.radians(np.linspace(self.lowest_deg, self.highest_deg, self.rings))
        azimuth = self.azimuth_rad() if azimuth is None else azimuth
        e, a = (grid.ravel() for grid in np.meshgrid(elevation, azimuth, indexing="ij"))
        return np.stack([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)], axis=1)

    def scan(
        self,
        street: Street,
        T_map_sensor: Matrix,
        generator: np.random.Generator,
        azimuth: Matrix | None = None,
    ) -> Points:
        """Return the scan at a pose: points (n, 3) in the sensor frame.

        :param azimuth: azimuths (a,) to measure; None for all.
        """
        directions = self.directions(azimuth)
        rays = directions @ T_map_sensor[:3, :3].T
        range_m = _nearest_hits(street, T_map_sensor[:3, 3], rays, self.range_m)
        hit = range_m < self.range_m
        measured = range_m[hit] + generator.normal(0.0, self.noise_m, int(hit.sum()))
        return (directions[hit] * measured[:, None]).astype(np.float32)


def _nearest_hits(street: Street, origin: Matrix, rays: Matrix, range_m: float) -> Matrix:
    """Return the distance (R,) along each ray to the nearest surface; infinity without a hit."""
    nearest = _ground(origin, rays)
    rays_by_axis = np.ascontiguousarray(rays.T)
    near_box = _is_near(origin, street.lower, street.upper, range_m)
    for lower, upper in zip(street.lower[near_box], street.upper[near_box], strict=True):
        np.minimum(nearest, _box(origin, rays_by_axis, lower, upper), out=nearest)
    near_upright = _is_near(origin, street.centres, street.centres, range_m)
    for index in np.flatnonzero(near_upright):
        centre, radius, height = street.centres[index], street.radii[index], street.heights[index]
        np.minimum(nearest, _cylinder(origin, rays, centre, radius, height), out=nearest)
    return nearest


def _is_near(origin: Matrix, lower: Matrix, upper: Matrix, range_m: float) -> npt.NDArray[np.bool_]:
    """Return which boxes of corners (B, 2 or 3) are in range, by x and y."""
    at = origin[:2]
    near: npt.NDArray[np.bool_] = np.all(
        (upper[:, :2] > at - range_m) & (lower[:, :2] < at + range_m), axis=1
    )
    return near


def _ground(origin: Matrix, rays: Matrix) -> Matrix:
    with np.errstate(divide="ignore"):
        distance = -origin[2] / rays[:, 2]
    return np.where(rays[:, 2] < 0.0, distance, np.inf)


def _box(origin: Matrix, rays_by_axis: Matrix, lower: Matrix, upper: Matrix) -> Matrix:
    """Intersect rays (3, R) with one box: the slab method."""
    with np.errstate(divide="ignore", invalid="ignore"):
        first, second = ((side - origin)[:, None] / rays_by_axis for side in (lower, upper))
    enter = np.minimum(first, second).max(axis=0)
    leave = np.maximum(first, second).min(axis=0)
    return np.where((enter <= leave) & (enter > 0.0), enter, np.inf)


def _cylinder(origin: Matrix, rays: Matrix, centre: Matrix, radius: float, height: float) -> Matrix:
    """Intersect rays with the lateral surface of one upright cylinder."""
    offset = origin[:2] - centre
    a = rays[:, 0] ** 2 + rays[:, 1] ** 2
    b = rays[:, :2] @ offset
    root = b * b - a * (offset @ offset - radius * radius)
    with np.errstate(divide="ignore", invalid="ignore"):
        distance = (-b - np.sqrt(root)) / a
    z = origin[2] + distance * rays[:, 2]
    hit = (root > 0.0) & (distance > 0.0) & (z > 0.0) & (z < height)
    return np.where(hit, distance, np.inf)
