# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A stopped subscriber does not slow its publisher down.

A publisher is slower if it does more work or waits. Its CPU time and its voluntary context switches
show both; the elapsed time on a busy machine does not.
"""

from __future__ import annotations

import os
import resource
import signal
import sys
import time
from statistics import median
from typing import NamedTuple

from std_msgs.msg import UInt8MultiArray

from support import wait_until
from support.nodes.payload import make_message, read_message
from support.nodes.ros import announce, peer_node, spin_until
from support.processes.commands import peer_command
from support.processes.inspection import is_stopped

MESSAGES = 2000
SIZE_BYTES = 20_000
ROUNDS = 7


class Burst(NamedTuple):
    """What a burst of messages cost the publishing thread."""

    cpu_ns: int
    waits: int


def cost_so_far() -> Burst:
    waits = resource.getrusage(resource.RUSAGE_THREAD).ru_nvcsw
    return Burst(time.thread_time_ns(), waits)


def publish_on_request() -> None:
    """For each line of input publish a burst and print its cost."""
    with peer_node("publisher") as node:
        publisher = node.create_publisher(UInt8MultiArray, "load", 10)
        spin_until(node, lambda: publisher.get_subscription_count() == 2)
        announce("ready")
        message = make_message(1, 1, SIZE_BYTES)
        for _ in sys.stdin:
            before = cost_so_far()
            for _ in range(MESSAGES):
                publisher.publish(message)
            after = cost_so_far()
            waits = after.waits - before.waits
            announce(f"took {after.cpu_ns - before.cpu_ns} ns of CPU, waited {waits} times")


def listen() -> None:
    with peer_node(f"subscriber_{os.getpid()}") as node:
        count = 0

        def hear(message: UInt8MultiArray) -> None:
            nonlocal count
            read_message(message)
            count += 1

        def answer() -> None:
            announce(f"heard {count}")

        node.create_subscription(UInt8MultiArray, "load", hear, 10)
        node.create_timer(0.1, answer)
        announce("ready")
        spin_until(node, lambda: False, timeout_s=3600)


def heard(subscriber) -> int:
    """Return a count that the subscriber prints from now on."""
    subscriber.skip_output()
    return int(subscriber.wait_for(r"heard (\d+)").group(1))


def test_stopped_subscribers(start):
    """Bursts alternate between subscribers awake and stopped; the cheapest are compared."""
    subscribers = [start(peer_command(listen), cluster) for cluster in (1, 2)]
    for subscriber in subscribers:
        subscriber.wait_for("ready")
    publisher = start(peer_command(publish_on_request))
    publisher.wait_for("ready")

    def burst() -> Burst:
        publisher.say("go")
        match = publisher.wait_for(r"took (\d+) ns of CPU, waited (\d+) times")
        return Burst(int(match.group(1)), int(match.group(2)))

    awake, stopped = [], []
    for _ in range(ROUNDS):
        awake.append(burst())
        for subscriber in subscribers:
            subscriber.signal(signal.SIGSTOP)
            wait_until(lambda s=subscriber: is_stopped(s.pid), "the subscriber is stopped")
        stopped.append(burst())
        for subscriber in subscribers:
            subscriber.signal(signal.SIGCONT)
    # Neighbours on the machine only add to the cost of a burst.
    assert min(b.cpu_ns for b in stopped) < 1.5 * min(b.cpu_ns for b in awake)
    assert min(b.waits for b in stopped) <= median(b.waits for b in awake)
    for subscriber in subscribers:
        before = heard(subscriber)
        burst()
        wait_until(lambda s=subscriber, b=before: heard(s) > b, "the subscriber hears again")
