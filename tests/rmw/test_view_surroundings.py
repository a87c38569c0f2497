# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Maps and judgements that the page of `manycore view` shows with the clouds of a topic."""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from builtin_interfaces.msg import Time
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from sensor_msgs.msg import PointCloud2

from rmw_manycore_py.cli.common import view
from rmw_manycore_py.cli.topic.listening import Listener
from rmw_manycore_py.cli.topic.surroundings import LOOK_PERIOD_S, Surroundings
from rmw_manycore_py.native._transport import EndpointInfo, Platform
from rmw_manycore_py.ndt.messages.point_cloud import encode
from support import IS_MANYCORE
from support.nodes.ros import peer_node, spin

pytestmark = pytest.mark.skipif(not IS_MANYCORE, reason="manycore is about rmw_manycore")

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


def cloud(frame: str, points: Any = ((0, 0, 0),)) -> PointCloud2:
    message: PointCloud2 = encode(np.array(points, np.float64), Time(), frame)
    return message


def publish_latched(node: Node, topic: str, message: PointCloud2) -> Any:
    publisher = node.create_publisher(PointCloud2, topic, LATCHED)
    publisher.publish(message)
    return publisher


class ReadPlatform:
    """A view of a platform that notes how it is read."""

    def __init__(self, opened: Platform) -> None:
        self._opened = opened
        self.generations: list[int] = []
        self.read_count = 0

    def graph_generation(self) -> int:
        self.generations.append(self._opened.graph_generation())
        return self.generations[-1]

    def endpoints(self) -> list[EndpointInfo]:
        self.read_count += 1
        return self._opened.endpoints()


def publish_scan_and_map() -> None:
    with peer_node() as node:
        publishers = [publish_latched(node, topic, cloud("map")) for topic in ("/scan", "/city")]
        assert len(publishers) == 2
        spin(node)


def test_the_graph_is_read_only_after_it_has_changed(start_peer: Callable[..., Any]) -> None:
    start_peer(publish_scan_and_map).wait_for("spinning")
    shown: list[Any] = []
    platform = os.environ["MANYCORE_PLATFORM"]

    def heard(message: Any) -> None:
        surroundings.belong_to(message.header.frame_id)

    def stop_in_time() -> None:
        if shown and read.generations[-6:].count(read.generations[-1]) == 6:
            listener.stop()

    with view.open_platform(platform) as opened:
        read: Any = ReadPlatform(opened)
        listener = Listener(platform, "/scan", None, heard)
        surroundings = Surroundings(listener, read, "/scan", shown.append)
        listener.every(LOOK_PERIOD_S, stop_in_time)
        listener.run()
    assert shown[0]["map"]["topic"] == "/city"
    assert read.read_count == len(set(read.generations))
