# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Sends large messages to subscriptions of the same node."""

from __future__ import annotations

import array
import os
import random
from collections.abc import Callable
from typing import Any

from rclpy.node import Node
from std_msgs.msg import Float64MultiArray, UInt8MultiArray

from support.nodes.ros import spin_until

LARGE_BYTES = 100_000
# By type code: types whose only number sequence is `data`.
TYPES = {"B": UInt8MultiArray, "d": Float64MultiArray}


def in_record(values: Any) -> bool:
    """Return whether an array lies in the record that its message was taken from."""
    return isinstance(values, array.array) and type(values) is not array.array


def large(typecode: str = "B", seed: int = 0, size_bytes: int = LARGE_BYTES) -> array.array[Any]:
    """Return numbers that differ from seed to seed."""
    source = random.Random(seed)
    if typecode == "B":
        return array.array("B", source.randbytes(size_bytes))
    count = size_bytes // array.array(typecode).itemsize
    return array.array(typecode, (source.randrange(1000) / 8 for _ in range(count)))


class Exchange:
    """A publisher and a subscription of one node."""

    def __init__(
        self, node: Node, topic: str = "large", typecode: str = "B", depth: int = 10
    ) -> None:
        self.node = node
        self.kind = TYPES[typecode]
        self.taken: list[Any] = []
        self.publisher = node.create_publisher(self.kind, topic, depth)
        self.subscription = node.create_subscription(self.kind, topic, self.taken.append, depth)
        spin_until(node, self.publisher.get_subscription_count)

    def __call__(self, values: array.array[Any]) -> array.array[Any]:
        """Return the values as they are taken."""
        message = self.kind()
        message.data = values
        self.publisher.publish(message)
        spin_until(self.node, lambda: self.taken)
        return self.taken.pop().data

    def destroy(self) -> None:
        self.node.destroy_subscription(self.subscription)
        self.node.destroy_publisher(self.publisher)


def status_of_child(act: Callable[[], Any]) -> int:
    """Return the exit status of a forked child that runs `act`: 0 if it returns."""
    child = os.fork()
    if child == 0:
        status = 1
        try:
            act()
            status = 0
        finally:
            os._exit(status)
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
