# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A map in tiles: which voxels a scan sees is found tile by tile, as each fits an SMEM."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.native import _ndt
from rmw_manycore_py.ndt.geometry.arrays import Matrix
from rmw_manycore_py.ndt.matching.kernel_options import map_options
from rmw_manycore_py.ndt.matching.options import MatcherOptions


class TileKey(NamedTuple):
    """Column and row of a tile, from the origin of the map frame."""

    column: int
    row: int


# How many voxels each point sees (N,), and the pairs of point and voxel (P, 12).
Pairs = tuple[NDArray[np.uint8], NDArray[np.float32]]


def tiles_of(
    points_m: NDArray[np.float64], tile_m: float, options: MatcherOptions
) -> dict[TileKey, _ndt.VoxelMap]:
    """Return the voxels of a map (N, 3) by tile, each with one voxel beyond its edges.

    :raises ManycoreError: if a tile does not consist of whole voxels, or none has a voxel.
    """
    if not np.isclose(tile_m % options.voxel_size_m, 0.0):
        expected = f"a multiple of the voxels' {options.voxel_size_m:g} m"
        raise ManycoreError(f"tiles: expected {expected}, found {tile_m:g} m", EXIT_BAD_INPUT)
    found = {}
    for column, strip in _strips(points_m, 0, tile_m, options.voxel_size_m):
        for row, points in _strips(strip, 1, tile_m, options.voxel_size_m):
            try:
                found[TileKey(column, row)] = _ndt.VoxelMap(points, map_options(options))
            except _ndt.NdtError:  # no voxel has enough points
                continue
    if not found:
        raise ManycoreError("the map has no voxel with enough points", EXIT_BAD_INPUT)
    return found


def _strips(
    points_m: NDArray[np.float64], axis: int, width_m: float, edge_m: float
) -> Iterator[tuple[int, NDArray[np.float64]]]:
    """Yield the points between multiples of a width along an axis, and those near its edges."""
    ordered = points_m[np.argsort(points_m[:, axis], kind="stable")]
    places = ordered[:, axis]
    for number in np.unique(np.floor(places / width_m).astype(int)).tolist():
        ends = number * width_m - edge_m, (number + 1) * width_m + edge_m
        first, last = np.searchsorted(places, ends)
        yield number, np.ascontiguousarray(ordered[first:last])


def points_by_tile(
    points_m: NDArray[np.float32], T_map_sensor: Matrix, tile_m: float
) -> dict[TileKey, NDArray[np.float32]]:
    """Return the points (N, 3) [sensor frame] by the tile they lie in at a pose (4, 4)."""
    places = points_m @ T_map_sensor[:2, :3].T + T_map_sensor[:2, 3]
    keys, group = np.unique(np.floor(places / tile_m).astype(int), axis=0, return_inverse=True)
    group = group.ravel()
    order = np.argsort(group, kind="stable")
    parts = np.split(points_m[order], np.flatnonzero(np.diff(group[order])) + 1)
    return (
        {
            TileKey(*key): np.ascontiguousarray(part)
            for key, part in zip(keys.tolist(), parts, strict=True)
        }
        if len(points_m)
        else {}
    )


def joined(parts: Iterable[Pairs]) -> Pairs:
    """Return the pairs of several groups of points as those of one."""
    counts, pairs = [np.zeros(0, np.uint8)], [np.zeros((0, 12), np.float32)]
    for part_counts, part_pairs in parts:
        counts.append(part_counts)
        pairs.append(part_pairs)
    return np.concatenate(counts), np.concatenate(pairs)


def split(found: Pairs, parts: int) -> list[Pairs]:
    """Return the pairs in `parts` parts of whole points and of about the same number of pairs."""
    counts, pairs = found
    ends = np.cumsum(counts, dtype=np.int64)
    wanted = len(pairs) * np.arange(1, parts) / parts
    points = [0, *np.searchsorted(ends, wanted).tolist(), len(counts)]
    rows = [0, *(int(ends[at - 1]) if at else 0 for at in points[1:-1]), len(pairs)]
    return [(counts[points[i] : points[i + 1]], pairs[rows[i] : rows[i + 1]]) for i in range(parts)]
