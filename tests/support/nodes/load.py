# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Nodes that load a platform in the stress tests, and are killed there."""

from __future__ import annotations

import ctypes
import os
import random
import signal
import sys
import threading
import time
from collections.abc import Callable

import rclpy
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import UInt8MultiArray

from support import TIMEOUT_S
from support.nodes.payload import make_message, read_message
from support.nodes.ros import announce, peer_node, spin_until

PR_SET_PDEATHSIG = 1  # <linux/prctl.h>
TOPIC = "load"
LARGEST_BYTES = 100_000
TOLD_GAP_NS = 200_000_000
SMALL_DSM_BYTES = 500_000  # a topic DSM with room for four of the largest messages
DEEP = QoSProfile(depth=2000)
LASTING = QoSProfile(depth=1000, durability=DurabilityPolicy.TRANSIENT_LOCAL)


def publish_steadily(rate_hz: float) -> None:
    """Publish messages of random sizes, the first one once a subscription matches.

    A line of input renews the publisher, whose topic DSM then has its first size.
    """
    with peer_node(f"steady_publisher_{os.getpid()}") as node:
        publisher = node.create_publisher(UInt8MultiArray, TOPIC, DEEP)
        spin_until(node, publisher.get_subscription_count)
        number = 0
        renewal = threading.Event()

        def publish() -> None:
            nonlocal number, publisher
            if renewal.is_set():
                renewal.clear()
                node.destroy_publisher(publisher)
                publisher = node.create_publisher(UInt8MultiArray, TOPIC, DEEP)
                announce("renewed")
            number += 1
            size_bytes = random.randrange(LARGEST_BYTES)
            publisher.publish(make_message(os.getpid(), number, size_bytes))

        def listen() -> None:
            for _ in sys.stdin:
                renewal.set()

        node.create_timer(1 / rate_hz, publish)
        threading.Thread(target=listen, daemon=True).start()
        announce(f"publishing as {os.getpid()}")
        rclpy.spin(node)


def check_steadily(writer: int) -> None:
    """Check every message, and the gaps between those of the one writer that is never killed.

    Prints long gaps at once, and on request how many messages arrived and how many are missing.
    """
    with peer_node(f"steady_subscriber_{os.getpid()}") as node:
        last, heard, missing = 0, 0, 0
        last_ns = 0

        def check(message: UInt8MultiArray) -> None:
            nonlocal last, last_ns, heard, missing
            try:
                found, number = read_message(message)
            except ValueError as error:
                announce(str(error))
                return
            if found != writer:
                return
            if number <= last:
                announce(f"wrong order: {number} after {last}")
            missing += number - last - 1 if last else 0
            now_ns = time.monotonic_ns()
            if last and now_ns - last_ns > TOLD_GAP_NS:
                announce(f"heard nothing from {last_ns} to {now_ns}")
            last, last_ns = number, now_ns
            heard += 1

        def answer() -> None:
            for _ in sys.stdin:
                announce(f"heard {heard}, missing {missing}")

        node.create_subscription(UInt8MultiArray, TOPIC, check, DEEP)
        threading.Thread(target=answer, daemon=True).start()
        announce("checking")
        rclpy.spin(node)


def publish_until_killed() -> None:
    with peer_node(f"publisher_{os.getpid()}") as node:
        publisher = node.create_publisher(UInt8MultiArray, TOPIC, 10)
        announce(f"victim {os.getpid()} works")
        number = 0
        while True:
            number += 1
            size_bytes = random.randrange(LARGEST_BYTES)
            publisher.publish(make_message(os.getpid(), number, size_bytes))
            rclpy.spin_once(node, timeout_sec=0.001)


def check_until_killed() -> None:
    with peer_node(f"subscriber_{os.getpid()}") as node:

        def check(message: UInt8MultiArray) -> None:
            try:
                read_message(message)
            except ValueError as error:
                announce(str(error))

        node.create_subscription(UInt8MultiArray, TOPIC, check, 10)
        announce(f"victim {os.getpid()} works")
        rclpy.spin(node)


def publish_without_rest() -> None:
    """Overwrite a small topic DSM as fast as possible; print each time it was filled twice."""
    with peer_node("restless_publisher") as node:
        publisher = node.create_publisher(UInt8MultiArray, TOPIC, 2)
        spin_until(node, publisher.get_subscription_count)
        number = 0
        while rclpy.ok():
            number += 1
            publisher.publish(make_message(os.getpid(), number, LARGEST_BYTES))
            if number % (2 * SMALL_DSM_BYTES // LARGEST_BYTES) == 0:
                announce("overwritten")


VICTIMS = {"publisher": publish_until_killed, "subscriber": check_until_killed}


def breed() -> None:
    """Fork a victim for each line of input, "KIND CLUSTER": Python imports everything only once.

    It forks before anything of ROS is initialised, so each child behaves like a new process.
    """
    signal.signal(signal.SIGCHLD, signal.SIG_IGN)  # the kernel reaps the dead
    announce("ready")
    for line in sys.stdin:
        kind, cluster = line.split()
        fork(VICTIMS[kind], cluster)


def fork(function: Callable[[], None], cluster: str) -> None:
    """Run a function in a child process and print its pid."""
    pid = os.fork()
    if pid:
        announce(f"born {pid}")
        return
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)  # no orphans if a test fails
    os.environ["MANYCORE_CLUSTER"] = cluster
    function()
    os._exit(0)


def crowd(size: int) -> None:
    """Fork `size` nodes in five clusters; each prints a line once it has heard all others."""
    signal.signal(signal.SIGCHLD, signal.SIG_IGN)
    for number in range(size):
        fork(lambda number=number: be_one_of(size, number), str(1 + number % 5))
    sys.stdin.read()


def join_at_once(size: int, endpoints: int) -> None:
    """Fork `size` nodes that wait for each other, then join and create `endpoints` each."""
    signal.signal(signal.SIGCHLD, signal.SIG_IGN)
    start, until_start = os.pipe()
    for number in range(size):
        fork(lambda: _join_at(start, until_start, endpoints), str(1 + number % 5))
    sys.stdin.readline()
    os.close(until_start)
    sys.stdin.read()


def _join_at(start: int, until_start: int, endpoints: int) -> None:
    os.close(until_start)
    os.read(start, 1)
    with peer_node(f"node_{os.getpid()}") as node:
        for number in range(endpoints):
            node.create_publisher(UInt8MultiArray, f"topic_{number}", 10)
        announce("has joined")
        rclpy.spin(node)


def be_one_of(size: int, number: int) -> None:
    with peer_node(f"node_{number}") as node:
        heard: set[int] = set()
        node.create_subscription(
            UInt8MultiArray, TOPIC, lambda message: heard.add(message.data[0]), LASTING
        )
        publisher = node.create_publisher(UInt8MultiArray, TOPIC, LASTING)
        _spin_until_all(node, lambda: publisher.get_subscription_count() == size)
        publisher.publish(UInt8MultiArray(data=[number]))
        _spin_until_all(node, lambda: len(heard) == size)
        announce(f"node {number} heard all")
        rclpy.spin(node)


def _spin_until_all(node: Node, condition: Callable[[], bool]) -> None:
    spin_until(node, condition, timeout_s=4 * TIMEOUT_S)
