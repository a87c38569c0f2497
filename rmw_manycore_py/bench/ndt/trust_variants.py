# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Drives through changed worlds: vehicles that the map lacks, and maps that end or lack a side."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np
import numpy.typing as npt

from rmw_manycore_py.bench.ndt import trust_worlds
from rmw_manycore_py.bench.ndt.trust_worlds import OPTIONS, Drive
from rmw_manycore_py.bench.ndt.world import RECORDING
from rmw_manycore_py.ndt.geometry.arrays import Matrix, Points

VEHICLES_M = ((4.3, 1.8, 1.5), (5.5, 2.0, 2.4), (9.0, 2.5, 3.4))  # length, width, height
CLEARANCE_M = 0.2  # between ground and vehicle
NEAREST_M, FARTHEST_M = 1.5, 12.0  # beside the sensor, to the near side of a vehicle
NOISE_M = 0.02
FOREIGN_SHARE = 0.4  # of the points of a scan
MAX_VEHICLES = 40
GROUND_WITHIN_M = 10.0
LEFT_KEPT_M = 20.0
SEED = 29
FINE = replace(OPTIONS, voxel_size_m=1.0, coarse_levels=(4.0, 2.0), wide_levels=(8.0,))
CHANGED = ("street 1", "street 2", RECORDING.removesuffix(".npz"))  # where it is there


def drives() -> dict[str, Callable[[], Drive]]:
    """Return a factory for each drive, by name; those in changed worlds as well."""
    found = trust_worlds.drives()
    for name in CHANGED:
        if name in found:
            for how, change in CHANGES.items():
                found[f"{name}, {how}"] = partial(_changed, found[name], change)
    return found


def _changed(drive: Callable[[], Drive], change: Callable[[Drive], Drive]) -> Drive:
    return change(drive())


def with_vehicles(drive: Drive, share: float = FOREIGN_SHARE) -> Drive:
    """Return a drive of whose points this share lies on vehicles that the map lacks."""

    def scan(index: int) -> Points:
        return hidden_by_vehicles(drive.scan(index), share, np.random.default_rng((SEED, index)))

    return replace(drive, scan=scan)


def hidden_by_vehicles(scan: Points, share: float, generator: np.random.Generator) -> Points:
    """Return a scan (N, 3) [m, sensor frame] whose rays end at vehicles until `share` do."""
    points = np.asarray(scan, np.float64)
    range_m = np.linalg.norm(points, axis=1)
    near = np.hypot(points[:, 0], points[:, 1]) < GROUND_WITHIN_M
    ground_m = float(np.quantile(points[near, 2], 0.05)) if near.any() else -2.0
    directions = points / np.maximum(range_m, 1e-6)[:, None]
    reached_m, foreign = range_m.copy(), np.zeros(len(points), bool)
    for _ in range(MAX_VEHICLES):
        if foreign.mean() >= share:
            break
        hit_m = _hits(directions, generator, ground_m)
        nearer = hit_m < reached_m
        foreign |= nearer
        reached_m[nearer] = hit_m[nearer] + generator.normal(0.0, NOISE_M, int(nearer.sum()))
    hidden: Points = (directions * reached_m[:, None]).astype(np.float32)
    return hidden


def _hits(directions: Matrix, generator: np.random.Generator, ground_m: float) -> Matrix:
    """Return the distance along each ray (N, 3) to a random vehicle; infinity without a hit."""
    length, width, height = VEHICLES_M[generator.integers(len(VEHICLES_M))]
    yaw = generator.choice([0.0, 0.0, 0.5 * np.pi]) + generator.normal(0.0, 0.1)
    bearing = generator.uniform(-np.pi, np.pi)
    away_m = generator.uniform(NEAREST_M, FARTHEST_M) + 0.5 * length
    centre = away_m * np.array([np.cos(bearing), np.sin(bearing)])
    along = np.array([[np.cos(yaw), np.sin(yaw)], [-np.sin(yaw), np.cos(yaw)]])
    rays = np.column_stack([directions[:, :2] @ along.T, directions[:, 2]])
    middle = np.array([*(along @ centre), ground_m + CLEARANCE_M + 0.5 * height])
    half = 0.5 * np.array([length, width, height])
    with np.errstate(divide="ignore", invalid="ignore"):
        sides = ((middle + side * half) / rays for side in (-1.0, 1.0))
        first, second = sides
    enter, leave = np.minimum(first, second).max(axis=1), np.maximum(first, second).min(axis=1)
    return np.where((enter <= leave) & (enter > 0.0), enter, np.inf)


Kept = Callable[[Matrix, Matrix], npt.NDArray[np.bool_]]


def with_part_of_map(drive: Drive, kept: Kept) -> Drive:
    """Return a drive in a part of its map.

    :param kept: of distance along the path and to its left [m], (N,) each, which points remain.
    """
    along_m, left_m = along_path(drive.poses[:, :2, 3], drive.map_points[:, :2].astype(np.float64))
    remains = kept(along_m, left_m)
    return replace(drive, map_points=drive.map_points[remains])


def along_path(path: Matrix, points: Matrix) -> tuple[Matrix, Matrix]:
    """Return for points (N, 2) the distance along a path (S, 2) [m] and to its left."""
    steps = np.diff(path, axis=0)
    apart = np.r_[True, np.linalg.norm(steps, axis=1) > 0.2]
    path = path[apart]
    heading = np.gradient(path, axis=0)
    heading /= np.linalg.norm(heading, axis=1)[:, None]
    driven_m = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1))]
    along, left = np.empty(len(points)), np.empty(len(points))
    for first in range(0, len(points), 50_000):
        some = points[first : first + 50_000]
        squared = ((some[:, None, :] - path[None]) ** 2).sum(axis=2)
        near = squared.argmin(axis=1)
        offset = some - path[near]
        ahead = heading[near]
        along[first : first + len(some)] = driven_m[near] + (offset * ahead).sum(axis=1)
        left[first : first + len(some)] = ahead[:, 0] * offset[:, 1] - ahead[:, 1] * offset[:, 0]
    return along, left


def without_far_left(drive: Drive) -> Drive:
    """Return a drive in a map that lacks what lies beyond 20 m to the left."""
    return with_part_of_map(drive, lambda _, left: left < LEFT_KEPT_M)


def without_left_half(drive: Drive) -> Drive:
    """Return a drive in a map that lacks all to the left of the path."""
    return with_part_of_map(drive, lambda _, left: left < 0.0)


def half_way(drive: Drive) -> Drive:
    """Return the first half of a drive, in a map that ends there."""
    path = drive.poses[:, :2, 3]
    along_m, _ = along_path(path, path)
    end_m = float(along_m[drive.tested].max()) / 2
    within = [index for index in drive.tested if along_m[index] < end_m]
    return with_part_of_map(replace(drive, tested=within), lambda along, _: along < end_m)


def with_fine_voxels(drive: Drive) -> Drive:
    """Return a drive that is matched with `ndt.resolution: 1.0`."""
    return replace(drive, options=FINE)


CHANGES: dict[str, Callable[[Drive], Drive]] = {
    "40 % on vehicles": with_vehicles,
    "no map on the left": without_left_half,
    f"no map beyond {LEFT_KEPT_M:g} m left": without_far_left,
    "map ends half-way": half_way,
    "40 % on vehicles, no map on the left": lambda drive: without_left_half(with_vehicles(drive)),
    "1 m voxels": with_fine_voxels,
    "40 % on vehicles, 1 m voxels": lambda drive: with_fine_voxels(with_vehicles(drive)),
    "no map on the left, 1 m voxels": lambda drive: with_fine_voxels(without_left_half(drive)),
}
