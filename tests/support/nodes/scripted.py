# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A node that publishes from timers and subscriptions: `scripted.py NAME JSON`.

The JSON lists callbacks: [period in ms, or topic; topic that it publishes].
"""

from __future__ import annotations

import json
import sys
from contextlib import suppress

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Empty


def add(node: Node, trigger: int | str, output: str) -> None:
    """Add a callback."""
    publisher = node.create_publisher(Empty, output, 10)
    if isinstance(trigger, str):
        node.create_subscription(Empty, trigger, publisher.publish, 10)
    else:
        node.create_timer(trigger / 1000, lambda: publisher.publish(Empty()))


def main(name: str, callbacks: str) -> None:
    """Run the node."""
    rclpy.init(args=sys.argv)
    node = Node(name)
    for trigger, output in json.loads(callbacks):
        add(node, trigger, output)
    with suppress(KeyboardInterrupt, ExternalShutdownException):
        rclpy.spin(node)


if __name__ == "__main__":
    main(*sys.argv[1:3])
