# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Voxel maps built in a separate process."""

from __future__ import annotations

import os
import signal
import threading
from concurrent.futures import Future

import numpy as np
import pytest

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.ndt import MatcherOptions, SerialMatcher, VoxelMap
from rmw_manycore_py.ndt.geometry.arrays import Points
from rmw_manycore_py.ndt.maps import map_process
from rmw_manycore_py.ndt.maps.map_builder import MapBuilder
from rmw_manycore_py.ndt.maps.map_tiles import TileFiles, open_map, write_tiles

pytestmark = pytest.mark.unit


class Taking:
    """Takes maps when the builder reports that one may be ready."""

    def __init__(self) -> None:
        self.built = threading.Semaphore(0)

    def __call__(self, builder: MapBuilder) -> object:
        assert builder.is_idle or self.built.acquire(timeout=60.0)
        return builder.take()


def test_maps_are_built_one_after_the_other_and_problems_are_reported():
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


@pytest.mark.parametrize("with_points", [True, False])
def test_tiles_are_read_where_the_map_is_built(tmp_path, with_points):
    """Of the same tiles it is the same map, read once; a tile that is gone is reported."""
    points = np.random.default_rng(1).uniform(0, 20, (20000, 3)).astype("f4")
    write_tiles(tmp_path, points, 10.0, ".npz")
    files = open_map(tmp_path).files_around(5.0, 5.0, 12.0)
    take = Taking()
    builder = MapBuilder(MatcherOptions(), take.built.release, with_points=with_points)
    builder.submit(lambda: files)
    here = take(builder)  # the first
    builder.submit(lambda: files)
    there = take(builder)
    assert there.voxel_map.own_score == here.voxel_map.own_score
    assert there.voxel_map.voxels == here.voxel_map.voxels
    lengths = [0 if one.points is None else len(one.points) for one in (here, there)]
    assert lengths == [with_points * len(points)] * 2
    files.paths[0].unlink()  # the process has its points
    builder.submit(lambda: files)
    assert take(builder).voxel_map.voxels == here.voxel_map.voxels
    builder.submit(lambda: TileFiles((tmp_path / "gone.npz",), 0.0))
    assert "there is no such file" in take(builder).problem
    builder.close()


def test_a_map_waits_for_one_tile_of_a_sample(tmp_path):
    points = np.random.default_rng(1).uniform(0, 40, (20000, 3)).astype("f4")
    points[:, 0] **= 2  # so tiles differ
    write_tiles(tmp_path, points, 100.0, ".npz")
    files = open_map(tmp_path).files_around(0.0, 0.0, 2000.0)
    built = Taking()
    was_read = []
    sample: Future[Points] = Future()

    def on_built() -> None:
        was_read.append(sample.done())
        built.built.release()

    builder = MapBuilder(MatcherOptions(), on_built)
    for _ in range(2):  # the second starts the process
        builder.submit(lambda: points)
        assert built(builder).voxel_map is not None
    helper = builder._helper.pid
    assert helper is not None
    os.kill(helper, signal.SIGSTOP)
    sample = builder.sample(files, 1600)
    builder.submit(lambda: points)
    os.kill(helper, signal.SIGCONT)
    assert built(builder).voxel_map is not None
    assert was_read[2] is False
    read = sample.result(timeout=60.0)
    assert len(read) == 1600
    counts, expected = (np.bincount((one[:, 0] // 100.0).astype(int)) for one in (read, points))
    np.testing.assert_allclose(counts, 0.08 * expected, atol=len(files.paths))
    assert len(builder.sample(files, len(points)).result(timeout=60.0)) == len(points)
    builder.close()


def test_a_sample_of_no_tiles_or_of_one_that_is_gone(tmp_path):
    builder = MapBuilder(MatcherOptions())
    assert builder.sample(TileFiles((), 0.0), 10).result(timeout=60.0).shape == (0, 3)
    gone = builder.sample(TileFiles((tmp_path / "gone.npz",), 0.0), 10)
    with pytest.raises(ManycoreError, match="there is no such file"):
        gone.result(timeout=60.0)
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
    again = take(builder)  # by another process, unless the kill hit the call
    builder.close()
    here = VoxelMap.from_points(points, options)
    assert {one.own_score for one in built} == {here.own_score}
    assert again.voxel_map is not None or "map builder" in again.problem
    found = []
    for voxel_map in (*built, here):
        matcher = SerialMatcher(options)
        matcher.set_map(voxel_map)
        found.append(matcher.align(points[::5], np.eye(4)).T_map_sensor.tolist())
    assert found[0] == found[1] == found[2]


def test_a_map_is_held_until_it_is_let_go_itself():
    """In virtual time the builders of a process hold their maps in one place."""
    points = np.random.default_rng(1).uniform(0, 20, (20000, 3)).astype("f4")
    options = MatcherOptions()
    ours, theirs = (map_process.build(points, options, with_points=False) for _ in range(2))
    map_process.let_go(theirs.shared_paths)
    attached = VoxelMap.attach(ours.shared_paths, options, ours.own_score)
    assert attached.voxels > 100
    map_process.let_go(ours.shared_paths)
    with pytest.raises(ManycoreError):
        VoxelMap.attach(ours.shared_paths, options, ours.own_score)
