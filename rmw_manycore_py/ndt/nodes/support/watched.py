# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Logs which node's publisher is gone, from the liveliness events of a subscription."""

from __future__ import annotations

from typing import Any

from rclpy.event_handler import SubscriptionEventCallbacks
from rclpy.node import Node


def watched(node: Node, topic: str) -> SubscriptionEventCallbacks:
    """Return subscription event callbacks that log which publishers died or left.

    rmw_manycore reports a death within milliseconds, DDS after the participant's lease.
    """
    return SubscriptionEventCallbacks(liveliness=_Watch(node, topic).changed)


class _Watch:
    """Remembers the publishers of a topic, since those that are gone cannot be queried."""

    def __init__(self, node: Node, topic: str) -> None:
        self._node = node
        self._topic = node.resolve_topic_name(topic)
        self._known: set[str] = set()

    def changed(self, event: Any) -> None:
        """Compare the publishers with those known before."""
        infos = self._node.get_publishers_info_by_topic(self._topic)
        present = {info.node_name for info in infos}
        gone = ", ".join(sorted(self._known - present))
        if not gone and event.not_alive_count_change > 0:  # the event does not name the publisher
            gone = " or ".join(sorted(self._known)) or "a publisher"
        if gone:
            self._node.get_logger().warning(f"{self._topic}: {gone} is gone")
        self._known = present
