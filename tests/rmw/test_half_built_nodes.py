# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Nodes that are destroyed while they are constructed, as rclpy does at shutdown since Kilted."""

from __future__ import annotations

from typing import Any

import pytest
from rclpy.node import Node

from rmw_manycore_py.ndt.nodes.ndt_scan_matcher import NdtScanMatcher
from rmw_manycore_py.papers.roslite.nodes.lidar_localizer import LidarLocalizer

pytestmark = pytest.mark.rmw


class BrokenOffError(Exception):
    """What ends the construction."""


@pytest.mark.parametrize(
    ("kind", "method"),
    [
        (NdtScanMatcher, "_make_tracking"),
        (NdtScanMatcher, "_listen"),
        (LidarLocalizer, "get_logger"),
    ],
)
def test_a_half_built_node_is_destroyed(node: Node, kind: type[Node], method: str) -> None:
    made: list[Node] = []

    def interrupt(self: Node, *_: Any) -> None:
        made.append(self)
        raise BrokenOffError

    with pytest.raises(BrokenOffError):
        type("BrokenOff", (kind,), {method: interrupt})()
    made[0].destroy_node()
    names = node.get_node_names()
    assert not {"ndt_scan_matcher", "lidar_localizer"} & set(names)
