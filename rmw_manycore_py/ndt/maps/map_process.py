# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Functions run in the helper process of `MapBuilder`."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias

from rmw_manycore_py.ndt.geometry.arrays import Points
from rmw_manycore_py.ndt.geometry.precision import why_coarse
from rmw_manycore_py.ndt.geometry.thinning import spread_indices
from rmw_manycore_py.ndt.maps.map_tiles import TileFiles
from rmw_manycore_py.ndt.matching.options import MatcherOptions
from rmw_manycore_py.ndt.matching.voxel_map import VoxelMap

Source: TypeAlias = Points | TileFiles

# By its first path, until another process has attached to it. In virtual time the builders of a
# process share it.
_held: dict[str, VoxelMap] = {}
_tiles: dict[Path, Points] = {}  # of the last map


@dataclass(frozen=True)
class HeldMap:
    """Location of a map: arguments of :meth:`VoxelMap.attach`.

    :param points: (N, 3) the map is built from, if requested.
    :param warning: reason for reduced map quality.
    """

    shared_paths: list[str]
    own_score: float
    points: Points | None
    warning: str


def build(source: Source, options: MatcherOptions, with_points: bool) -> HeldMap:
    """Build a map and hold it until `let_go`."""
    voxel_map, held = built(source, options, with_points=with_points)
    _held[held.shared_paths[0]] = voxel_map
    return held


def built(
    source: Source, options: MatcherOptions, *, with_points: bool
) -> tuple[VoxelMap, HeldMap]:
    """Return a map of points (N, 3) or of tiles, and its location."""
    points = source.read(_tiles) if isinstance(source, TileFiles) else source
    voxel_map = VoxelMap.from_points(points, options)
    returned = points if with_points else None
    where = voxel_map.shared_paths, voxel_map.own_score
    return voxel_map, HeldMap(*where, returned, why_coarse(points))


def sample_of(tile: TileFiles, seen: int, max_count: int) -> tuple[Points, int]:
    """Return a tile's share (N, 3) of `max_count` points, and `seen` with the tile's points.

    Keeps none that the maps do not.

    :param seen: number of points of the tiles before, of all of which the sample is.
    """
    points = tile.read(dict(_tiles))
    seen += len(points)
    share = len(points) * max_count // max(seen, max_count)
    return points[spread_indices(len(points), share)], seen


def let_go(shared_paths: list[str]) -> None:
    """Release a map; processes that have attached keep it."""
    _held.pop(shared_paths[0], None)
