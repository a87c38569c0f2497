# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Charges the memory that a matcher shares with its workers to its cluster's SMEM."""

from __future__ import annotations

from rclpy.node import Node

from rmw_manycore_py.ndt.matching.matcher import Matcher
from rmw_manycore_py.ndt.matching.voxel_map import VoxelMap
from rmw_manycore_py.ndt.nodes.support.smem import SmemCharge


class ClusterMemory:
    """Keeps the charge of a matcher's shared memory; no-op with another RMW.

    :raises ManycoreError: if the cluster has no room; the charge is then unchanged.
    """

    def __init__(self, node: Node, matcher: Matcher) -> None:
        self._matcher = matcher
        self._charge = SmemCharge(node, "shared memory for map and scan")
        self._charge.hold(matcher.shared_bytes())

    def make_room_for_map(self, next_map: VoxelMap) -> None:
        """Charge a map beside the current one."""
        self._charge.hold(self._matcher.shared_bytes(next_map=next_map))

    def make_room_for_scan(self, points: int) -> None:
        """Charge a scan of `points` points."""
        self._charge.hold(self._matcher.shared_bytes(points))

    def make_room_for_search(self, size_bytes: int) -> None:
        """Charge what a search shares, beside map and scan."""
        self._charge.hold(self._matcher.shared_bytes() + size_bytes)

    def give_back(self) -> None:
        """Reduce the charge to what the matcher holds now."""
        self._charge.hold(self._matcher.shared_bytes())
