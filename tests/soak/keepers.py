# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Nodes of a soak of holds: publishers of large messages, and readers that keep, copy and change
them, and look again later whether each byte is still the publisher's, or their own."""

from __future__ import annotations

import copy
import os
import pickle
import random
import sys
import threading
import zlib
from typing import Any

import numpy as np
import rclpy
from std_msgs.msg import UInt8MultiArray

from support.nodes.payload import HEADER, make_message, read_message
from support.nodes.ros import announce, peer_node

DEPTH = 10
SMALLEST_BYTES, LARGEST_BYTES = 64 << 10, 256 << 10
MAX_KEPT = 20  # more than may be held, so that some are copies
TOLD = 100  # takes
FORKED, COPIED, CHANGED, KEPT = 0.002, 0.02, 0.3, 0.6  # shares of the messages


def publish_kept(topic: str) -> None:
    """Publish messages of random sizes without rest."""
    with peer_node(f"publisher_{os.getpid()}") as node:
        publisher = node.create_publisher(UInt8MultiArray, topic, DEPTH)
        announce("works")
        number = 0
        while True:
            number += 1
            size_bytes = random.randrange(SMALLEST_BYTES, LARGEST_BYTES)
            publisher.publish(make_message(os.getpid(), number, size_bytes))
            rclpy.spin_once(node, timeout_sec=0)


class Kept:
    """A message and the checksum of what it must hold."""

    def __init__(self, message: UInt8MultiArray) -> None:
        self._message = message
        self._sum = zlib.crc32(memoryview(message.data))

    def change(self) -> None:
        """Write into all bytes, which others must not see."""
        values = np.frombuffer(self._message.data, np.uint8)
        if values.flags.writeable:
            np.bitwise_not(values, out=values)
            self._sum = zlib.crc32(values)

    def check(self) -> None:
        """Report foreign bytes."""
        if zlib.crc32(memoryview(self._message.data)) != self._sum:
            announce(f"foreign: {HEADER.unpack_from(self._message.data)}")


class Keeper:
    """Takes messages and does at random what programs may do with them."""

    def __init__(self) -> None:
        self._kept: list[Kept] = []
        self._takes = 0
        self.rests = threading.Event()

    def take(self, message: UInt8MultiArray) -> None:
        """Handle a message."""
        try:
            read_message(message)
        except ValueError as error:
            announce(str(error))
        self._act(message)
        self._takes += 1
        if self._takes % TOLD == 0:
            announce("took")

    def look(self) -> None:
        """Check all kept messages."""
        for one in self._kept:
            one.check()

    def drop_all(self) -> None:
        """Check and drop all messages."""
        self.look()
        self._kept.clear()

    def _act(self, message: UInt8MultiArray) -> None:
        kept = Kept(message)
        if random.random() < COPIED:
            _check_copies(message)
        if random.random() < CHANGED:
            kept.change()
        if random.random() < KEPT:
            self._kept.append(kept)
        while len(self._kept) > random.randrange(MAX_KEPT):
            self._kept.pop(random.randrange(len(self._kept))).check()
        if random.random() < FORKED:
            self._fork()

    def _fork(self) -> None:
        """Let a child check what it inherits, and change it."""
        child = os.fork()
        if child == 0:
            self.look()
            for one in self._kept:
                one.change()
            self.look()
            os._exit(0)
        if status := os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]):
            announce(f"foreign: a child ended with {status}")


def _check_copies(message: UInt8MultiArray) -> None:
    """Compare copies of a message, which do not share its memory, with the message."""
    others: list[Any] = [copy.deepcopy(message), pickle.loads(pickle.dumps(message))]
    longer = copy.copy(message)
    longer.data = message.data[:]
    longer.data.append(0)
    if any(other != message for other in others) or longer.data[:-1] != message.data:
        announce("foreign: a copy differs")


def keep(topic: str) -> None:
    """Take messages of a topic; each line of input lets go of all."""
    keeper = Keeper()

    def listen() -> None:
        for _ in sys.stdin:
            keeper.rests.set()

    with peer_node(f"keeper_{os.getpid()}") as node:
        node.create_subscription(UInt8MultiArray, topic, keeper.take, DEPTH)
        threading.Thread(target=listen, daemon=True).start()
        announce("works")
        while True:
            rclpy.spin_once(node, timeout_sec=0.05)
            if keeper.rests.is_set():
                keeper.rests.clear()
                keeper.drop_all()
                announce("rests")
