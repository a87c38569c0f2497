# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Nodes of a soak: some stay, the others join, grow, get stuck and are killed."""

from __future__ import annotations

import signal
import sys
import time
from collections.abc import Callable

import rclpy
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import UInt8MultiArray
from std_srvs.srv import Trigger

from support.nodes.load import TOPIC, check_until_killed, fork, publish_until_killed
from support.nodes.payload import make_message
from support.nodes.ros import announce, peer_node

BURST_TOPIC = "bursts"
SERVICE = "calls"
RENEW = "renew"
LARGEST_BURST_BYTES = 1_000_000
BURST_MESSAGES = 16
STUCK = QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL)


def publish_bursts() -> None:
    """For each line of input, publish a burst of large messages, or renew the publisher."""
    with peer_node("bursts") as node:
        publisher = node.create_publisher(UInt8MultiArray, BURST_TOPIC, BURST_MESSAGES)
        announce("bursting")
        for number, line in enumerate(sys.stdin):
            if line.strip() == RENEW:
                node.destroy_publisher(publisher)
                publisher = node.create_publisher(UInt8MultiArray, BURST_TOPIC, BURST_MESSAGES)
                announce("renewed")
                continue
            for _ in range(BURST_MESSAGES):
                publisher.publish(make_message(1, number, LARGEST_BURST_BYTES))
            for _ in range(BURST_MESSAGES):
                publisher.publish(make_message(1, number, 10))


def be_stuck() -> None:
    """Subscribe to everything and take nothing."""
    with peer_node("stuck") as node:
        for topic in (TOPIC, BURST_TOPIC):
            node.create_subscription(UInt8MultiArray, topic, lambda _: None, 10)
        time.sleep(LONG_S)


def grow() -> None:
    """Publish ever larger messages, kept for late subscriptions."""
    with peer_node("growing") as node:
        publisher = node.create_publisher(UInt8MultiArray, BURST_TOPIC, STUCK)
        size_bytes = 1000
        while True:
            publisher.publish(make_message(2, 0, size_bytes))
            size_bytes = min(size_bytes * 2, LARGEST_BURST_BYTES)
            rclpy.spin_once(node, timeout_sec=0.01)


def rebuild() -> None:
    """Create and destroy endpoints of all kinds."""
    with peer_node("rebuilding") as node:
        while True:
            publisher = node.create_publisher(UInt8MultiArray, TOPIC, 10)
            subscription = node.create_subscription(UInt8MultiArray, TOPIC, lambda _: None, 10)
            client = node.create_client(Trigger, SERVICE)
            publisher.publish(make_message(3, 0, 1000))
            rclpy.spin_once(node, timeout_sec=0.01)
            node.destroy_client(client)
            node.destroy_subscription(subscription)
            node.destroy_publisher(publisher)


def serve() -> None:
    """Serve calls."""

    def answer(_: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        response.success = True
        return response

    with peer_node("server") as node:
        node.create_service(Trigger, SERVICE, answer)
        rclpy.spin(node)


def call() -> None:
    """Call any available server, without waiting for the responses."""
    with peer_node("client") as node:
        client = node.create_client(Trigger, SERVICE)
        while True:
            client.call_async(Trigger.Request())
            rclpy.spin_once(node, timeout_sec=0.01)


LONG_S = 3600.0
ACTORS: dict[str, Callable[[], None]] = {
    "publisher": publish_until_killed,
    "subscriber": check_until_killed,
    "stuck": be_stuck,
    "growing": grow,
    "rebuilding": rebuild,
    "server": serve,
    "client": call,
}


def breed_actors() -> None:
    """Fork an actor for each line of input, "KIND CLUSTER", before ROS is initialised."""
    signal.signal(signal.SIGCHLD, signal.SIG_IGN)  # the kernel reaps children
    announce("ready")
    for line in sys.stdin:
        kind, cluster = line.split()
        fork(ACTORS[kind], cluster)
