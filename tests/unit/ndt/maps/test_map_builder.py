# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Voxel maps that a process of its own builds."""

from __future__ import annotations

import os
import signal
import threading

import numpy as np
import pytest

from rmw_manycore_py.ndt import MatcherOptions, SerialMatcher, VoxelMap
from rmw_manycore_py.ndt.maps.map_builder import MapBuilder

pytestmark = pytest.mark.unit


class Taking:
    """Takes maps once the builder says that there may be one."""

    def __init__(self) -> None:
        self.built = threading.Semaphore(0)

    def __call__(self, builder: MapBuilder) -> object:
        assert builder.is_idle or self.built.acquire(timeout=60.0)
        return builder.take()


def test_maps_are_built_one_after_the_other_and_problems_are_told():
    points = np.random.default_rng(1).uniform(0, 20, (20000, 3)).astype("f4")
    take = Taking()
    builder = MapBuilder(MatcherOptions(), take.built.release)
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


def test_a_map_outlives_the_process_that_built_it_and_is_what_it_would_be_here():
    points = np.random.default_rng(1).uniform(0, 20, (20000, 3)).astype("f4")
    options = MatcherOptions()
    take = Taking()
    builder = MapBuilder(options, take.built.release)
    built = []
    for _ in range(2):  # the first map is built in this process
        builder.submit(lambda: points)
        built.append(take(builder).voxel_map)
    helper = builder._helper.pid
    assert helper is not None
    os.kill(helper, signal.SIGKILL)
    builder.submit(lambda: points)
    again = take(builder)  # by another process, unless the kill came amid the call
    builder.close()
    here = VoxelMap.from_points(points, options)
    assert {one.own_likelihood for one in built} == {here.own_likelihood}
    assert again.voxel_map is not None or "map builder" in again.problem
    found = []
    for voxel_map in (*built, here):
        matcher = SerialMatcher(options)
        matcher.set_map(voxel_map)
        found.append(matcher.align(points[::5], np.eye(4)).T_map_sensor.tolist())
    assert found[0] == found[1] == found[2]
