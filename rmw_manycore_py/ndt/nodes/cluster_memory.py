# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What a matcher shares with its workers, as part of its cluster's SMEM."""

from __future__ import annotations

import os

from rclpy.node import Node
from rclpy.utilities import get_rmw_implementation_identifier

from rmw_manycore_py import _transport
from rmw_manycore_py.errors import ManycoreError


class ClusterMemory:
    """Keeps the platform's account of a node's shared memory; with another RMW there is none."""

    def __init__(self, node: Node) -> None:
        self._platform = ""
        if get_rmw_implementation_identifier() == "rmw_manycore":
            domain = f"domain-{node.context.get_domain_id()}"
            self._platform = os.environ.get("MANYCORE_PLATFORM") or domain
        self._held_bytes = 0

    def hold(self, size_bytes: int) -> None:
        """Take up so much from now on, instead of what was held before.

        :raises ManycoreError: when the cluster has no room for more; then nothing has changed.
        """
        if not self._platform or size_bytes == self._held_bytes:
            return
        try:
            _transport.charge_smem(self._platform, size_bytes)
        except _transport.PlatformError as error:
            raise ManycoreError(f"map and scan need more shared memory: {error}") from error
        self._held_bytes = size_bytes
