# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Publisher of what only observers want, such as clouds and markers."""

from __future__ import annotations

from typing import Any

from rclpy._rclpy_pybind11 import RCLError
from rclpy.node import Node
from rclpy.qos import QoSProfile

from rmw_manycore_py.errors import reported
from rmw_manycore_py.ndt.nodes.support.log_throttle import ThrottledLog


class DetailPublisher:
    """Logs why a message cannot be published: an observer must not end the localization."""

    def __init__(self, node: Node, message_type: Any, name: str, qos: QoSProfile | int) -> None:
        self._node = node
        self._name = name
        self._publisher = node.create_publisher(message_type, name, qos)
        self._log = ThrottledLog(node.get_logger().warning)

    @property
    def is_wanted(self) -> bool:
        """Return whether there are subscriptions."""
        return bool(self._publisher.get_subscription_count() > 0)

    def publish(self, message: Any) -> bool:
        """Publish a message; return whether what is left of the cluster's SMEM had room for it."""
        try:
            self._publisher.publish(message)
        except RCLError as error:
            if not self._node.context.ok():
                raise
            self._log(f"{self._name} is not published: {reported(error)}")
            return False
        return True
