# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Topics that are transferred to other clusters: unmodified rclpy nodes, and their QoS."""

from __future__ import annotations

import ctypes
import random
import sys
from typing import Any

import pytest
import rclpy
from geometry_msgs.msg import Point
from rclpy._rclpy_pybind11 import RCLError
from rclpy.duration import Duration
from rclpy.event_handler import SubscriptionEventCallbacks
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile
from std_msgs.msg import Int32, UInt8MultiArray

from support import IS_MANYCORE
from support.nodes.handles import rcl, rcl_handle
from support.nodes.ros import announce, peer_node, spin_until
from support.nodes.transferred import KINDS, configure
from support.processes.commands import manycore_command

pytestmark = pytest.mark.skipif(not IS_MANYCORE, reason="transfers are rmw_manycore's")

TOPICS = ["/ping", "/pong", "/numbers", "/points"]
# Numbers are not: all fit into a data pipe, and each might not be received in time.
SYNCHRONOUS = ["/ping", "/pong"]
# 1.5 MiB exceeds what a data pipe holds.
SIZES = [0, 1, 64, 4000, 4096, 65_536, 1_500_000, 100, 0]
SHORT_S = 0.1


@pytest.fixture(params=KINDS)
def kind(request: pytest.FixtureRequest, start_peer) -> str:
    """Configure the platform before rclpy joins it."""
    kind = str(request.param)
    synchronous = SYNCHRONOUS if kind == "message" else []
    start_peer(configure, kind, TOPICS, 2, synchronous).wait_for("configured")
    return kind


@pytest.fixture
def moved(kind, node):
    """Yield a node in cluster 1 of a platform whose topics are transferred."""
    return node


def publish(publisher: Any, message: Any) -> None:
    """Publish until a synchronous message is received in time: a busy machine takes longer."""
    while True:
        try:
            publisher.publish(message)
        except RCLError as error:
            if "it is synchronous, and cluster" not in str(error):
                raise
        else:
            return


def echo() -> None:
    with peer_node() as node:
        publisher = node.create_publisher(UInt8MultiArray, "pong", 10)
        node.create_subscription(UInt8MultiArray, "ping", lambda m: publish(publisher, m), 10)
        spin_until(node, publisher.get_subscription_count)
        announce("ready")
        rclpy.spin(node)


def test_every_size_there_and_back(moved, start_peer):
    received: list[Any] = []
    sent: list[Any] = []  # one that was late comes more than once
    publisher = moved.create_publisher(UInt8MultiArray, "ping", 10)
    moved.create_subscription(UInt8MultiArray, "pong", received.append, 10)
    peer = start_peer(echo, cluster=2)
    peer.wait_for("ready")
    spin_until(moved, publisher.get_subscription_count)
    for size in SIZES:
        message = UInt8MultiArray(data=random.randbytes(size))
        sent.append(message)
        publish(publisher, message)
        spin_until(moved, lambda m=message: m in received)
        assert all(m in sent[-2:] for m in received), f"{size} bytes came back changed"
        received.clear()


def count(depth: int, last: int) -> None:
    """Publish numbers from 1 on, all at once."""
    with peer_node() as node:
        publisher = node.create_publisher(Int32, "numbers", QoSProfile(depth=depth))
        spin_until(node, publisher.get_subscription_count)
        for number in range(1, last + 1):
            publisher.publish(Int32(data=number))
        announce("published")
        sys.stdin.read()


def test_a_shallow_subscription_has_the_newest_in_order_and_counts_the_others(moved, start_peer):
    received, lost = [], []
    events = SubscriptionEventCallbacks(message_lost=lost.append)
    moved.create_subscription(Int32, "numbers", received.append, 3, event_callbacks=events)
    peer = start_peer(count, 100, 50, cluster=2)
    peer.wait_for("published")
    spin_until(moved, lambda: received and received[-1].data == 50)
    numbers = [message.data for message in received]
    assert numbers == sorted(numbers)
    spin_until(moved, lambda: lost and lost[-1].total_count == 50 - len(numbers))


def test_two_publishers_each_in_order(moved, start_peer):
    received: list[int] = []
    qos = QoSProfile(history=HistoryPolicy.KEEP_ALL)
    moved.create_subscription(Int32, "numbers", lambda message: received.append(message.data), qos)
    for _ in range(2):
        start_peer(count, 100, 30, cluster=2).wait_for("published")
    spin_until(moved, lambda: len(received) == 60)
    assert received == [*range(1, 31), *range(1, 31)]


def test_messages_of_a_publisher_that_has_gone_arrive(moved, start_peer):
    received: list[int] = []
    moved.create_subscription(Int32, "numbers", lambda message: received.append(message.data), 100)
    peer = start_peer(count, 100, 40, cluster=2)
    peer.wait_for("published")
    peer.kill()
    spin_until(moved, lambda: len(received) == 40)
    assert received == [*range(1, 41)]


def publish_once() -> None:
    with peer_node() as node:
        qos = QoSProfile(depth=10, deadline=Duration(seconds=SHORT_S))
        publisher = node.create_publisher(Int32, "numbers", qos)
        spin_until(node, publisher.get_subscription_count)
        publisher.publish(Int32(data=1))
        announce("published")
        rclpy.spin(node)


def test_missed_deadlines_are_counted(moved, start_peer):
    missed: list[Any] = []
    events = SubscriptionEventCallbacks(deadline=missed.append)
    qos = QoSProfile(depth=10, deadline=Duration(seconds=SHORT_S))
    moved.create_subscription(Int32, "numbers", lambda _: None, qos, event_callbacks=events)
    start_peer(publish_once, cluster=2).wait_for("published")
    spin_until(moved, lambda: missed and missed[-1].total_count >= 2)


def test_the_end_of_a_publisher_is_reported(moved, start_peer):
    changes: list[Any] = []
    events = SubscriptionEventCallbacks(liveliness=changes.append)
    moved.create_subscription(Int32, "numbers", lambda _: None, 10, event_callbacks=events)
    peer = start_peer(count, 10, 1, cluster=2)
    peer.wait_for("published")
    spin_until(moved, lambda: changes and changes[-1].alive_count == 1)
    peer.kill()
    spin_until(moved, lambda: changes[-1].alive_count == 0)


def lends(publisher: Any) -> bool:
    function = rcl.rcl_publisher_can_loan_messages
    function.restype = ctypes.c_bool
    return bool(function(rcl_handle(publisher)))


def test_transferred_topics_do_not_lend(moved):
    assert lends(moved.create_publisher(Point, "elsewhere", 10))
    assert not lends(moved.create_publisher(Point, "points", 10))


def test_a_history_for_later_subscriptions_is_refused(moved):
    qos = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    with pytest.raises(RCLError, match="durability transient_local, and the topic is transferred"):
        moved.create_publisher(Int32, "numbers", qos)
    moved.create_publisher(Int32, "others", qos)


def test_a_message_beyond_the_size_is_refused(moved):
    publisher = moved.create_publisher(UInt8MultiArray, "ping", 10)
    with pytest.raises(RCLError, match="set its topic_dsm_size to at least"):
        publisher.publish(UInt8MultiArray(data=bytes(5 << 20)))


def test_topic_info_names_the_transfer(moved, kind, start):
    moved.create_publisher(Int32, "numbers", 10)
    info = start(manycore_command("topic", "info", "/numbers", "--verbose"))
    assert info.wait() == 0
    assert f"Transfer: {kind}" in info.lines
