# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Alignment of one scan with one map in a single call."""

from __future__ import annotations

from typing import Any

from numpy.typing import ArrayLike, NDArray

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.ndt.geometry.arrays import pose_error, pose_matrix, real_numbers
from rmw_manycore_py.ndt.matching.alignment import Alignment
from rmw_manycore_py.ndt.matching.options import MatcherOptions
from rmw_manycore_py.ndt.matching.serial_matcher import SerialMatcher
from rmw_manycore_py.ndt.matching.voxel_map import VoxelMap


def align(
    target: ArrayLike | VoxelMap,
    scan: ArrayLike,
    T_map_guess: ArrayLike,
    *,
    options: MatcherOptions | None = None,
) -> Alignment:
    """Find the pose near a guess at which a LiDAR scan fits a map best, on the calling thread.

    To align several scans pass a :class:`VoxelMap`, else each call builds the map again.
    :class:`WorkerMatcher` finds the same pose with worker processes.

    :param target: points (N, 3) [m, map frame], or a map built from them.
    :param scan: points (M, 3) [m, sensor frame]. Points that are not finite are dropped, here and
        in the target.
    :param T_map_guess: (4, 4), transforms points from the sensor frame to the map frame; it has
        to be within about 8 m and 45 degrees of the pose.
    :param options: options of map and matcher; by default those of a given map.
    :return: the pose, its score and covariance, and whether it converged.
    :raises ManycoreError: if an argument has another shape or is not numeric, if the guess is not a
        pose, if no voxel of the map has enough points, or if the map has other options.
    """
    guess = pose_matrix(real_numbers("T_map_guess", T_map_guess, "(4, 4)"))
    if wrong := pose_error(guess):
        raise ManycoreError(f"T_map_guess: it {wrong}", EXIT_BAD_INPUT)
    points = _points("scan", scan)
    if not isinstance(target, VoxelMap):
        target = VoxelMap.from_points(_points("target", target), options)
    matcher = SerialMatcher(target.options if options is None else options)
    matcher.set_map(target)
    return matcher.align(points, guess)


def _points(name: str, value: ArrayLike) -> NDArray[Any]:
    points = real_numbers(name, value, "(N, 3)")
    if points.ndim != 2 or points.shape[1] != 3:
        raise ManycoreError(f"{name}: expected shape (N, 3), found {points.shape}", EXIT_BAD_INPUT)
    return points
