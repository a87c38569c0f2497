# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Builds voxel maps in the background, to be swapped in between two scans.

A separate niced process reads tiles and builds voxels (map_process.py): sharing a CPU with a
building thread made matching several times slower. A thread takes points out of messages and waits
for that process. It builds the first map itself, since no scan can be matched before it and a
process takes time to start.
"""

from __future__ import annotations

import os
import threading
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass

from rmw_manycore_py.errors import what_is_wrong
from rmw_manycore_py.ndt.geometry.arrays import Points
from rmw_manycore_py.ndt.maps import map_process
from rmw_manycore_py.ndt.maps.map_process import HeldMap, Source
from rmw_manycore_py.ndt.maps.map_sample import MapSample
from rmw_manycore_py.ndt.maps.map_tiles import TileFiles
from rmw_manycore_py.ndt.matching.options import MatcherOptions
from rmw_manycore_py.ndt.matching.voxel_map import VoxelMap
from rmw_manycore_py.process.helper_process import HelperProcess, leave_real_time
from rmw_manycore_py.process.steady import steady_s

NICENESS = 10

Read = Callable[[], Source | None]


@dataclass(frozen=True)
class BuiltMap:
    """Result: a map, or a problem; neither if the map has not changed.

    :param points: (N, 3), if the builder returns them.
    :param warning: reason for reduced map quality.
    """

    voxel_map: VoxelMap | None
    points: Points | None
    problem: str
    warning: str
    duration_ms: float


class MapBuilder:
    """Builds maps, one at a time; of pending requests, only the newest is built.

    Thread-safe, except that `take` belongs to one thread.
    """

    def __init__(
        self,
        options: MatcherOptions,
        built: Callable[[], None] = lambda: None,
        *,
        with_points: bool = True,
    ) -> None:
        """Start the thread; it calls `built` whenever there is a result to take.

        :param with_points: return the points of each map, too.
        """
        self._options = options
        self._with_points = with_points
        self._built = built
        self._helper = HelperProcess("map builder", NICENESS)
        self._is_first = True
        self._executor = ThreadPoolExecutor(1, "map", leave_real_time)
        self._running: Future[BuiltMap] | None = None
        self._waiting: Read | None = None
        self._lock = threading.Lock()

    @property
    def is_idle(self) -> bool:
        """Return whether no map is being built or waits to be taken."""
        return self._running is None

    def submit(self, read: Read) -> None:
        """Build a map from the points or tiles returned by `read`, if any."""
        with self._lock:
            if self._running is None:
                self._running = self._start(read)
            else:
                self._waiting = read

    def take(self) -> BuiltMap | None:
        """Return the finished result, once."""
        running = self._running
        if running is None or not running.done():
            return None
        built = running.result()
        with self._lock:
            waiting, self._waiting = self._waiting, None
            self._running = self._start(waiting) if waiting is not None else None
        return built

    def sample(self, files: TileFiles, max_count: int) -> Future[Points]:
        """Have the process read at most `max_count` points (N, 3) of tiles, spread over them.

        A map that is to be built meanwhile waits for one tile at most.
        """
        sample = MapSample(files, max_count)
        self._executor.submit(self._sample_tile, sample)
        return sample.points

    def close(self) -> None:
        """Stop the process and the thread."""
        self._helper.close()
        self._executor.shutdown(wait=True, cancel_futures=True)

    def _sample_tile(self, sample: MapSample) -> None:
        """Have a tile read; the next one is behind a map that waits."""
        try:
            sample.read_tile(self._helper)
            if not sample.points.done():
                self._executor.submit(self._sample_tile, sample)
        except Exception as error:  # such as a tile that is gone, or the end of this builder
            sample.points.set_exception(error)

    def _start(self, read: Read) -> Future[BuiltMap]:
        running = self._executor.submit(self._build, read)
        running.add_done_callback(lambda _: self._built())
        return running

    def _build(self, read: Read) -> BuiltMap:
        start_s = steady_s()
        voxel_map, held, problem = None, None, ""
        try:
            source = read()
            if source is not None:
                voxel_map, held = self._first(source) if self._is_first else self._next(source)
        except Exception as error:  # on any error, keep the previous map
            problem = what_is_wrong(error)
        duration_ms = 1e3 * (steady_s() - start_s)
        points, warning = (held.points, held.warning) if held is not None else (None, "")
        return BuiltMap(voxel_map, points, problem, warning, duration_ms)

    def _first(self, source: Source) -> tuple[VoxelMap, HeldMap]:
        built, held = map_process.built(source, self._options, with_points=self._with_points)
        self._is_first = False
        self._executor.submit(self._helper.call, os.getpid)  # starts the helper
        return built, held

    def _next(self, source: Source) -> tuple[VoxelMap, HeldMap]:
        held = self._helper.call(map_process.build, source, self._options, self._with_points)
        try:
            attached = VoxelMap.attach(held.shared_paths, self._options, held.own_score)
            return attached, held
        finally:
            self._helper.call(map_process.let_go, held.shared_paths)
