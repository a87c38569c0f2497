# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""NDT scan matching: finds where in a map of normal distributions a LiDAR scan fits best."""

from rmw_manycore_py.ndt.matching.alignment import Alignment, Score
from rmw_manycore_py.ndt.matching.matcher import Matcher, SerialMatcher
from rmw_manycore_py.ndt.matching.options import MatcherOptions
from rmw_manycore_py.ndt.matching.voxel_map import VoxelMap
from rmw_manycore_py.ndt.matching.worker_matcher import WorkerMatcher

__all__ = [
    "Alignment",
    "Matcher",
    "MatcherOptions",
    "Score",
    "SerialMatcher",
    "VoxelMap",
    "WorkerMatcher",
]
