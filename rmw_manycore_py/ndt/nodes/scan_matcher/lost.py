# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Finds a scan in the whole map, on the workers, between scans."""

from __future__ import annotations

from collections.abc import Generator

from rmw_manycore_py.ndt.geometry.arrays import ScanPoints
from rmw_manycore_py.ndt.matching.alignment import Alignment
from rmw_manycore_py.ndt.matching.matcher import Matcher
from rmw_manycore_py.ndt.nodes.scan_matcher.cluster_memory import ClusterMemory
from rmw_manycore_py.ndt.nodes.scan_matcher.rejected import Rejected
from rmw_manycore_py.ndt.trust.score_level import ScoreLevel
from rmw_manycore_py.ndt.trust.search import Region, search_steps


def search_region(
    matcher: Matcher, memory: ClusterMemory, scan: ScanPoints, region: Region
) -> Generator[bool, None, Alignment]:
    """Return the alignment at the only place of a region where a scan (N, 3) fits.

    :raises Rejected: if it fits at none, or at several.
    """
    memory.make_room_for_scan(len(scan))
    try:
        found = yield from search_steps(matcher, scan, region, memory.make_room_for_search)
    finally:
        memory.give_back()
    level = ScoreLevel()
    level.map_changed(matcher.map.own_score)
    if unclear := found.why_unclear(level, region):
        raise Rejected(f"searching within {region.radius_m:.0f} m: {unclear}")
    return found.places[0]
