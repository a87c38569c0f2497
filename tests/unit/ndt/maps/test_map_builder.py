# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Voxel maps that a thread builds."""

from __future__ import annotations

import numpy as np
import pytest

from rmw_manycore_py.ndt import MatcherOptions
from rmw_manycore_py.ndt.maps.map_builder import MapBuilder

pytestmark = pytest.mark.unit


def take(builder: MapBuilder) -> object:
    return builder.take(wait=True)


def test_maps_are_built_one_after_the_other_and_problems_are_told():
    points = np.random.default_rng(1).uniform(0, 20, (20000, 3)).astype("f4")
    builder = MapBuilder(MatcherOptions())
    for source in (points, points[:0], points):
        builder.submit(lambda source=source: source)
    first, newest = take(builder), take(builder)
    assert first.voxel_map.voxels == newest.voxel_map.voxels > 100
    assert builder.is_idle
    builder.submit(lambda: points[:0])
    assert take(builder).problem
    builder.submit(lambda: None)
    assert (take(builder).voxel_map, take(builder)) == (None, None)
    builder.submit(lambda: points[10**25 :])
    assert take(builder).voxel_map is None
    builder.submit(lambda: 1 // 0)
    assert take(builder).problem == "integer division or modulo by zero"
    builder.close()
