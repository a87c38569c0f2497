# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Voxel maps built beside the work that goes on, to be swapped in between two scans.

A thread reads points. Voxels are built in a process of its own (map_process.py), whose CPU time
counts less: where matcher and thread shared a CPU, scans took several times as long meanwhile. The
first map is built in the thread: no scan can be matched before it, and a process takes its time to
start.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass

from rmw_manycore_py.errors import what_is_wrong
from rmw_manycore_py.helper_process import HelperProcess, leave_real_time
from rmw_manycore_py.ndt.geometry.arrays import Points
from rmw_manycore_py.ndt.geometry.precision import why_coarse
from rmw_manycore_py.ndt.maps import map_process
from rmw_manycore_py.ndt.matching.options import MatcherOptions
from rmw_manycore_py.ndt.matching.voxel_map import VoxelMap

NICENESS = 10


@dataclass(frozen=True)
class BuiltMap:
    """What came of it: a map, or why there is none; None and no problem: nothing has changed.

    :param warning: what makes the map worse than it could be.
    """

    voxel_map: VoxelMap | None
    points: Points | None
    problem: str
    warning: str
    duration_ms: float


class MapBuilder:
    """One thread reads points and has voxels built; of what waits, only the newest is done.

    Thread-safe, but for `take`, which belongs to one thread.
    """

    def __init__(self, options: MatcherOptions, built: Callable[[], None] = lambda: None) -> None:
        """Start a thread; it calls `built` whenever there is something to take."""
        self._options = options
        self._built = built
        self._helper = HelperProcess("map builder", NICENESS)
        self._is_first = True
        self._executor = ThreadPoolExecutor(1, "map", leave_real_time)
        self._running: Future[BuiltMap] | None = None
        self._waiting: Callable[[], Points | None] | None = None
        self._lock = threading.Lock()

    @property
    def is_idle(self) -> bool:
        """Tell whether nothing is built or waits to be taken."""
        return self._running is None

    def submit(self, read: Callable[[], Points | None]) -> None:
        """Build a map of the points that `read` returns, if it returns some."""
        with self._lock:
            if self._running is None:
                self._running = self._start(read)
            else:
                self._waiting = read

    def take(self) -> BuiltMap | None:
        """Return what is finished, once."""
        running = self._running
        if running is None or not running.done():
            return None
        built = running.result()
        with self._lock:
            waiting, self._waiting = self._waiting, None
            self._running = self._start(waiting) if waiting is not None else None
        return built

    def close(self) -> None:
        """End the process, and the thread with what it is doing."""
        self._helper.close()
        self._executor.shutdown(wait=True, cancel_futures=True)

    def _start(self, read: Callable[[], Points | None]) -> Future[BuiltMap]:
        running = self._executor.submit(self._build, read)
        running.add_done_callback(lambda _: self._built())
        return running

    def _build(self, read: Callable[[], Points | None]) -> BuiltMap:
        start = time.perf_counter()
        voxel_map, points, problem, warning = None, None, "", ""
        try:
            points = read()
            if points is not None:
                voxel_map = self._voxels_of(points)
                warning = why_coarse(points)
        except Exception as error:  # whatever is wrong with a map, the one before it stays
            problem = what_is_wrong(error)
        duration_ms = 1e3 * (time.perf_counter() - start)
        return BuiltMap(voxel_map, points, problem, warning, duration_ms)

    def _voxels_of(self, points: Points) -> VoxelMap:
        if self._is_first:
            first = VoxelMap.from_points(points, self._options)
            self._is_first = False
            self._executor.submit(self._helper.call, map_process.let_go)  # starts it
            return first
        held = self._helper.call(map_process.build, points, self._options)
        try:
            return VoxelMap.attach(held.shared_paths, self._options, held.own_likelihood)
        finally:
            self._helper.call(map_process.let_go)
