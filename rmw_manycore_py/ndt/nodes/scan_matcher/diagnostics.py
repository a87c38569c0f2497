# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Status of a node on `/diagnostics`, in the form of Autoware's nodes."""

from __future__ import annotations

from typing import Any

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from rclpy.node import Node

from rmw_manycore_py.ndt.nodes.support.log_throttle import LogThrottle


class Diagnostics:
    """One status: collects values and messages, then publishes them together."""

    def __init__(self, node: Node, name: str) -> None:
        self._node = node
        self._name = f"{node.get_name()}: {name}"
        self._publisher = node.create_publisher(DiagnosticArray, "/diagnostics", 10)
        self._throttle = LogThrottle()
        self.clear()

    def clear(self) -> None:
        """Start a new report."""
        self._values: list[Any] = []
        self._level = DiagnosticStatus.OK
        self._messages: list[str] = []

    def value(self, key: str, value: object) -> None:
        """Add a value; booleans are formatted as in Autoware."""
        text = str(value) if isinstance(value, bool) else f"{value}"
        self._values.append(KeyValue(key=key, value=text))

    def warn(self, message: str) -> None:
        """Report a warning, also in the log."""
        self._add(DiagnosticStatus.WARN, message)
        if self._throttle.is_due(message):
            self._node.get_logger().warning(message)

    def error(self, message: str) -> None:
        """Report an error, also in the log."""
        self._add(DiagnosticStatus.ERROR, message)
        if self._throttle.is_due(message):
            self._node.get_logger().error(message)

    def note(self, message: str) -> None:
        """Report a warning without logging it."""
        self._add(DiagnosticStatus.WARN, message)

    def publish(self, stamp: Any) -> None:
        """Publish the report."""
        status = DiagnosticStatus(
            level=self._level,
            name=self._name,
            hardware_id=self._node.get_name(),
            message="; ".join(self._messages) or "OK",
            values=self._values,
        )
        message = DiagnosticArray(status=[status])
        message.header.stamp = stamp
        self._publisher.publish(message)

    def _add(self, level: bytes, message: str) -> None:
        self._level = max(self._level, level)
        self._messages.append(message)
