# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What the helper process of `MapBuilder` does, so that building takes no CPU time from scans."""

from __future__ import annotations

from dataclasses import dataclass

from rmw_manycore_py.ndt.geometry.arrays import Points
from rmw_manycore_py.ndt.matching.options import MatcherOptions
from rmw_manycore_py.ndt.matching.voxel_map import VoxelMap

_held: list[VoxelMap] = []  # until others have attached to it


@dataclass(frozen=True)
class HeldMap:
    """Where the map is; parameters of :meth:`VoxelMap.attach`."""

    shared_paths: list[str]
    own_likelihood: float


def build(points: Points, options: MatcherOptions) -> HeldMap:
    """Build a map of points (N, 3), and hold it until `let_go`."""
    _held[:] = [VoxelMap.from_points(points, options)]
    return HeldMap(_held[0].shared_paths, _held[0].own_likelihood)


def let_go() -> None:
    """Forget the map; those that have attached keep it."""
    _held.clear()
