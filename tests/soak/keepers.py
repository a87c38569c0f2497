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
from typing import Any

import rclpy
from sensor_msgs.msg import CompressedImage  # converted by none before, see `preload`

from support.nodes.payload import HEADER, make_bytes, read_message
from support.nodes.ros import announce, peer_node

DEPTH = 10
SMALLEST_BYTES, LARGEST_BYTES = 64 << 10, 1 << 20
SIZES_SHAPE = 3  # of a Pareto distribution: mostly small ones, for many takes
MAX_KEPT = 20  # more than may be held, so that some are copies
TOLD = 100  # takes
REST, GO_ON = "rest", "go on"  # commands, and the answers to them
FORKED, COPIED, CHANGED, KEPT = 0.002, 0.02, 0.3, 0.6  # shares of the messages


def publish_kept(topic: str) -> None:
    """Publish messages of random sizes without rest."""
    with peer_node(f"publisher_{os.getpid()}") as node:
        publisher = node.create_publisher(CompressedImage, topic, DEPTH)
        announce("works")
        number = 0
        while True:
            number += 1
            size_bytes = int(SMALLEST_BYTES * random.paretovariate(SIZES_SHAPE))
            data = make_bytes(os.getpid(), number, min(size_bytes, LARGEST_BYTES))
            publisher.publish(CompressedImage(data=data))


class Kept:
    """A message, with the writer and number that it must hold."""

    def __init__(self, message: CompressedImage) -> None:
        self._message = message
        self._expected = _read(message)

    def change(self) -> None:
        """Write into all bytes, which others must not see."""
        values = memoryview(self._message.data)
        if not values.readonly:
            self._expected = (os.getpid(), random.getrandbits(32))
            values[:] = make_bytes(*self._expected, len(values) - HEADER.size)

    def check(self) -> None:
        """Report foreign bytes."""
        if (found := _read(self._message)) != self._expected:
            announce(f"foreign: {found} instead of {self._expected}")


def _read(message: CompressedImage) -> tuple[int, int] | None:
    """Return writer and number of a message; report it if it is torn."""
    try:
        return read_message(message)
    except ValueError as error:
        announce(str(error))
        return None


class Keeper:
    """Takes messages and does at random what programs may do with them."""

    def __init__(self) -> None:
        self._kept: list[Kept] = []
        self._takes = 0
        self._takes_in_place = 0  # of a reader that is read-only
        self._rests = False

    def take(self, message: CompressedImage) -> None:
        """Handle a message."""
        if not self._rests:
            self._act(message)
        self._takes += 1
        self._takes_in_place += memoryview(message.data).readonly
        if self._takes % TOLD == 0:
            announce("took")

    def look(self) -> None:
        """Check all kept messages."""
        for one in self._kept:
            one.check()

    def obey(self, command: str) -> None:
        """Check and drop all messages, and keep none until told to."""
        self.look()
        self._kept.clear()
        self._rests = command == REST
        if self._rests and not self._takes_in_place:
            announce("foreign: all messages are copies")
        announce(command)

    def _act(self, message: CompressedImage) -> None:
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


def _check_copies(message: CompressedImage) -> None:
    """Compare copies of a message, which do not share its memory, with the message."""
    others: list[Any] = [copy.deepcopy(message), pickle.loads(pickle.dumps(message))]
    longer = copy.copy(message)
    longer.data = message.data[:]
    longer.data.append(0)
    if any(other != message for other in others) or longer.data[:-1] != message.data:
        announce("foreign: a copy differs")


def keep(topic: str, zero_copy: str) -> None:
    """Take messages of a topic, and obey each line of input."""
    os.environ["MANYCORE_ZERO_COPY"] = zero_copy
    keeper = Keeper()

    def listen() -> None:
        for line in sys.stdin:
            rclpy.get_global_executor().create_task(keeper.obey, line.strip())

    with peer_node(f"keeper_{os.getpid()}") as node:
        node.create_subscription(CompressedImage, topic, keeper.take, DEPTH)
        threading.Thread(target=listen, daemon=True).start()
        announce("works")
        rclpy.spin(node)
