# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Nodes that publish texts and that print received texts, on either side of a bridge."""

from __future__ import annotations

import time
from typing import Any

from support.nodes.ros import announce, peer_node, spin_until, type_of


def qos(words: dict[str, Any]) -> Any:
    """Return a profile from names of policies, as JSON contains them."""
    from rclpy.duration import Duration
    from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

    durability = DurabilityPolicy[words.get("durability", "volatile").upper()]
    reliability = ReliabilityPolicy[words.get("reliability", "reliable").upper()]
    times = {key: Duration(nanoseconds=words[key]) for key in ("deadline",) if key in words}
    depth = words.get("depth", 10)
    return QoSProfile(depth=depth, durability=durability, reliability=reliability, **times)


def say(topic: str, words: dict[str, Any], period_s: float | None, *texts: str) -> None:
    """Publish texts at once, and, with a period, the time forever, once a period."""
    with peer_node("speaker") as node:
        publisher = node.create_publisher(type_of("std_msgs/msg/String"), topic, qos(words))
        message = type_of("std_msgs/msg/String")
        for text in texts:
            publisher.publish(message(data=text))
        if period_s:

            def say_time() -> None:
                publisher.publish(message(data=f"again {time.time_ns()}"))

            node.create_timer(period_s, say_time)
        announce("said")
        spin_until(node, lambda: False, 1e6)


def hear(topic: str, words: dict[str, Any]) -> None:
    """Print each message received, with its source timestamp."""
    with peer_node("hearer") as node:

        def heard(message: Any, info: Any) -> None:
            announce(f"heard {message.data} {info['source_timestamp']}")

        node.create_subscription(type_of("std_msgs/msg/String"), topic, heard, qos(words))
        announce("listening")
        spin_until(node, lambda: False, 1e6)


def flood(topic: str) -> None:
    """Publish much more than the buffers of a slow link or a stopped subscriber hold."""
    with peer_node("flooder") as node:
        message = type_of("std_msgs/msg/String")(data="x" * 200_000)
        publisher = node.create_publisher(type_of("std_msgs/msg/String"), topic, qos({}))
        node.create_timer(0.005, lambda: publisher.publish(message))
        announce("flooding")
        spin_until(node, lambda: False, 1e6)
