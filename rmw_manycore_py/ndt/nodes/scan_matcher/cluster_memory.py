# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What a matcher shares with its workers, as part of its cluster's SMEM."""

from __future__ import annotations

from rclpy.node import Node
from rclpy.utilities import get_rmw_implementation_identifier

from rmw_manycore_py import _transport
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.ndt.matching.matcher import Matcher
from rmw_manycore_py.ndt.matching.voxel_map import VoxelMap
from rmw_manycore_py.ros.domain import default_platform


class ClusterMemory:
    """Keeps the platform's account of a matcher's shared memory; with another RMW there is none.

    Where the cluster has no room for more a ManycoreError says so, and nothing has changed.
    """

    def __init__(self, node: Node, matcher: Matcher) -> None:
        self._matcher = matcher
        self._platform = ""
        if get_rmw_implementation_identifier() == "rmw_manycore":
            self._platform = default_platform(node.context.get_domain_id())
        self._held_bytes = 0
        self._hold(matcher.shared_bytes())

    def make_room_for_map(self, next_map: VoxelMap) -> None:
        """Take up the place of a map beside the present one."""
        self._hold(self._matcher.shared_bytes(next_map=next_map))

    def make_room_for_scan(self, points: int) -> None:
        """Take up the place of a scan."""
        self._hold(self._matcher.shared_bytes(points))

    def give_back(self) -> None:
        """Keep the place of what the matcher has now."""
        self._hold(self._matcher.shared_bytes())

    def _hold(self, size_bytes: int) -> None:
        if not self._platform or size_bytes == self._held_bytes:
            return
        try:
            _transport.charge_smem(self._platform, size_bytes)
        except _transport.PlatformError as error:
            if size_bytes < self._held_bytes:
                return  # too much is held, until the next call
            raise ManycoreError(f"shared memory for map and scan: {error}") from error
        self._held_bytes = size_bytes
