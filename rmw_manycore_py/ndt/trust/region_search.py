# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Pose search in a separate process, so that scans and guesses never wait for it."""

from __future__ import annotations

from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import replace

from rmw_manycore_py.ndt.geometry.arrays import ScanPoints
from rmw_manycore_py.ndt.matching.options import MatcherOptions
from rmw_manycore_py.ndt.matching.serial_matcher import SerialMatcher
from rmw_manycore_py.ndt.matching.voxel_map import VoxelMap
from rmw_manycore_py.ndt.trust.search import Found, Region, search
from rmw_manycore_py.process.helper_process import HelperProcess, leave_real_time

NICENESS = 5


class RegionSearch:
    """Runs one search at a time; the first one starts the process."""

    def __init__(self, options: MatcherOptions) -> None:
        self._options = options
        self._map: VoxelMap | None = None
        self._helper = HelperProcess("pose search", NICENESS)
        self._executor = ThreadPoolExecutor(1, "search", leave_real_time)
        self._running: Future[Found] | None = None

    def map_changed(self, voxel_map: VoxelMap) -> None:
        """Use another map from the next search on."""
        self._map = voxel_map

    @property
    def is_idle(self) -> bool:
        """Return whether a search may start: none is running or waiting to be taken."""
        return self._running is None and self._map is not None

    def begin(self, scan: ScanPoints, region: Region) -> None:
        """Start a search for a scan (N, 3) [m, base frame], if idle."""
        if self.is_idle and self._map is not None:
            self._running = self._executor.submit(self._search, self._map, scan, region)

    def take(self) -> Found | None:
        """Return the result once; None while a search runs, or without a search.

        :raises ManycoreError: if the search failed.
        """
        running = self._running
        if running is None or not running.done():
            return None
        self._running = None
        return running.result()

    def close(self) -> None:
        """Stop the process, whatever it is doing."""
        self._helper.close()
        self._executor.shutdown(wait=True, cancel_futures=True)

    def _search(self, voxel_map: VoxelMap, scan: ScanPoints, region: Region) -> Found:
        # Keep the map until the result arrives: the helper attaches to this process's memory.
        paths = voxel_map.shared_paths
        own_score = voxel_map.own_score
        return self._helper.call(search_in_map, paths, own_score, self._options, scan, region)


def search_in_map(
    shared_paths: list[str],
    own_score: float,
    options: MatcherOptions,
    scan: ScanPoints,
    region: Region,
) -> Found:
    """Search in the map of another process."""
    only_pose = replace(options, pose_covariance="fixed")
    matcher = SerialMatcher(only_pose)
    matcher.set_map(VoxelMap.attach(shared_paths, only_pose, own_score))
    return search(matcher, scan, region)
