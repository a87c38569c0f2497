# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The loaded map for observers: `debug/loaded_pointcloud_map`."""

from __future__ import annotations

from concurrent.futures import Future

from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from sensor_msgs.msg import PointCloud2

from rmw_manycore_py.errors import what_is_wrong
from rmw_manycore_py.ndt.geometry.arrays import Points
from rmw_manycore_py.ndt.maps.map_area import RETRY_S
from rmw_manycore_py.ndt.maps.map_tiles import TileFiles
from rmw_manycore_py.ndt.messages.point_cloud import encode
from rmw_manycore_py.ndt.nodes.scan_matcher.detail_publisher import DetailPublisher
from rmw_manycore_py.ndt.nodes.scan_matcher.map_supply import MapSupply
from rmw_manycore_py.process.steady import steady_s

TOPIC = "debug/loaded_pointcloud_map"
MAX_SAMPLE = 100_000  # points: enough to draw, and little beside a map


class LoadedMap:
    """Publishes points of the loaded map, transient local.

    With the parameter `publish_loaded_map` all of each map, as the node takes it. Without, a sample
    of the loaded tiles once there is a subscription, and again after other tiles were loaded. What
    had no room is published some seconds later, and tiles that could not be read are read again.
    Methods belong to one thread.
    """

    def __init__(self, node: Node, map_frame: str, supply: MapSupply) -> None:
        kept = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self._publisher = DetailPublisher(node, PointCloud2, TOPIC, kept)
        self._node = node
        self._map_frame = map_frame
        self._supply = supply
        self._sampled: TileFiles | None = None
        self._reading: Future[Points] | None = None
        self._unpublished: PointCloud2 | None = None
        self._retry_s = 0.0

    def publish(self, points: Points) -> None:
        """Publish points (N, 3), later if there is no room for them."""
        stamp = self._node.get_clock().now().to_msg()
        self._publish(encode(points, stamp, self._map_frame))

    def retry(self) -> None:
        """Publish what had no room."""
        if self._unpublished is not None and steady_s() > self._retry_s:
            self._publish(self._unpublished)

    def look(self) -> None:
        """Publish a sample that has been read, or have one read if it is wanted."""
        self.retry()
        if self._reading is not None and self._reading.done():
            self._publish_read(self._reading)
        files = self._supply.loaded_files
        if self._reading is not None or files is None or files == self._sampled:
            return
        if self._publisher.is_wanted and steady_s() > self._retry_s:
            self._sampled = files
            self._reading = self._supply.sample(files, MAX_SAMPLE)

    def _publish(self, message: PointCloud2) -> None:
        is_published = self._publisher.publish(message)
        self._unpublished = None if is_published else message
        if not is_published:
            self._retry_s = steady_s() + RETRY_S

    def _publish_read(self, reading: Future[Points]) -> None:
        self._reading = None
        try:
            self.publish(reading.result())
        except Exception as error:  # such as a tile that is gone
            self._node.get_logger().warning(f"{TOPIC} is not published: {what_is_wrong(error)}")
            self._sampled = None
            self._retry_s = steady_s() + RETRY_S
