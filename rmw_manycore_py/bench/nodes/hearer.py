# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Takes all messages of some topics.

Usage: hearer TOPIC=TYPE...
"""

from __future__ import annotations

import sys
from contextlib import suppress
from importlib import import_module

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy

DEPTH = 1000


def main() -> None:
    """Take messages until interrupted."""
    rclpy.init()
    node = Node("hearer")
    # Of best effort, to match publishers of either reliability.
    qos = QoSProfile(depth=DEPTH, reliability=ReliabilityPolicy.BEST_EFFORT)
    for word in sys.argv[1:]:
        topic, _, name = word.partition("=")
        package, _, kind = name.rpartition("/")
        type_ = getattr(import_module(package.replace("/", ".")), kind)
        node.create_subscription(type_, topic, lambda _: None, qos, raw=True)
    with suppress(KeyboardInterrupt, ExternalShutdownException):
        rclpy.spin(node)


if __name__ == "__main__":
    main()
