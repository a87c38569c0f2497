# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Charges memory outside the segment, which a node holds, to its cluster's SMEM."""

from __future__ import annotations

from rclpy.node import Node
from rclpy.utilities import get_rmw_implementation_identifier

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.native import _transport
from rmw_manycore_py.ros.domain import default_platform


class SmemCharge:
    """Keeps the charge of a node; no-op with another RMW.

    :param what: what the memory is for, in errors.
    """

    def __init__(self, node: Node, what: str) -> None:
        self._what = what
        self._platform = ""
        if get_rmw_implementation_identifier() == "rmw_manycore":
            self._platform = default_platform(node.context.get_domain_id())
        self._held_bytes = 0

    def hold(self, size_bytes: int) -> None:
        """Set the charge to `size_bytes`.

        :raises ManycoreError: if the cluster has no room; the charge is then unchanged.
        """
        if not self._platform or size_bytes == self._held_bytes:
            return
        try:
            _transport.charge_smem(self._platform, size_bytes)
        except _transport.PlatformError as error:
            if size_bytes < self._held_bytes:
                return  # overcharged until the next call
            raise ManycoreError(f"{self._what}: {error}") from error
        self._held_bytes = size_bytes
