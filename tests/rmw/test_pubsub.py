# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Messages of every type and size arrive as they were sent, within a cluster and between two."""

from __future__ import annotations

import random

import pytest
import rclpy
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.serialization import deserialize_message, serialize_message
from std_msgs.msg import String, UInt8MultiArray
from test_msgs.message_fixtures import get_test_msg

from support.nodes.ros import announce, peer_node, spin_until, type_of

SIZES = [0, 1, 3, 64, 1000, 4096, 65_536, 1 << 20, 8 << 20, 100, 0]

TEST_TYPES = [
    "Arrays",
    "BasicTypes",
    "BoundedPlainSequences",
    "BoundedSequences",
    "Builtins",
    "Constants",
    "Defaults",
    "Empty",
    "MultiNested",
    "Nested",
    "Strings",
    "UnboundedSequences",
    "WStrings",
]


def echo(type_name: str, raw: bool = False) -> None:
    """Send every message from `ping` back on `pong`."""
    with peer_node() as node:
        publisher = node.create_publisher(type_of(type_name), "pong", 10)
        node.create_subscription(type_of(type_name), "ping", publisher.publish, 10, raw=raw)
        spin_until(node, publisher.get_subscription_count)
        announce("ready")
        rclpy.spin(node)


class Ping:
    """Sends a message to the echo and returns what comes back."""

    def __init__(self, node: Node, message_type: type) -> None:
        self._node = node
        self._received: list[object] = []
        self._publisher = node.create_publisher(message_type, "ping", 10)
        node.create_subscription(message_type, "pong", self._received.append, 10)
        spin_until(node, self._publisher.get_subscription_count)

    def __call__(self, message: object) -> object:
        self._publisher.publish(message)
        spin_until(self._node, lambda: self._received)
        return self._received.pop()


def test_every_size(node, start_peer, peer_cluster):
    peer = start_peer(echo, "std_msgs/msg/UInt8MultiArray", cluster=peer_cluster)
    ping = Ping(node, UInt8MultiArray)
    peer.wait_for("ready")
    for size in SIZES:
        message = UInt8MultiArray(data=random.randbytes(size))
        assert ping(message) == message, f"{size} bytes came back changed"


@pytest.mark.parametrize("name", TEST_TYPES)
def test_every_kind_of_field(node, start_peer, name):
    peer = start_peer(echo, f"test_msgs/msg/{name}", cluster=2)
    ping = Ping(node, type_of(f"test_msgs/msg/{name}"))
    peer.wait_for("ready")
    for message in get_test_msg(name):
        assert ping(message) == message


def test_serialized_messages(node, start_peer, peer_cluster):
    """A raw subscription and a publisher of bytes pass CDR on without deserialising it."""
    peer = start_peer(echo, "std_msgs/msg/String", True, cluster=peer_cluster)
    ping = Ping(node, String)
    peer.wait_for("ready")
    assert ping(serialize_message(String(data="as bytes"))) == String(data="as bytes")


def test_raw_bytes_are_standard_cdr(node):
    received = []
    publisher = node.create_publisher(String, "raw", 10)
    node.create_subscription(String, "raw", received.append, 10, raw=True)
    spin_until(node, publisher.get_subscription_count)
    publisher.publish(String(data="hello"))
    spin_until(node, lambda: received)
    header, length, text = received[0][:4], received[0][4:8], received[0][8:]
    assert (header, length) == (b"\x00\x01\x00\x00", b"\x06\x00\x00\x00")
    assert text == b"hello\x00\x00\x00"  # padded to whole words
    assert deserialize_message(received[0], String) == String(data="hello")


def test_best_effort(node, start_peer, peer_cluster):
    received = []
    qos = QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT)
    node.create_subscription(String, "chatter", received.append, qos)
    start_peer(talk_best_effort, cluster=peer_cluster)
    spin_until(node, lambda: len(received) >= 3)


def talk_best_effort() -> None:
    with peer_node() as node:
        qos = QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT)
        publisher = node.create_publisher(String, "chatter", qos)
        node.create_timer(0.02, lambda: publisher.publish(String(data="any")))
        rclpy.spin(node)


def test_publisher_hears_itself(node):
    """Subscriptions of the publishing process are readers like all others."""
    received = []
    publisher = node.create_publisher(String, "chatter", 10)
    for _ in range(3):
        node.create_subscription(String, "chatter", received.append, 10)
    spin_until(node, lambda: publisher.get_subscription_count() == 3)
    publisher.publish(String(data="x"))
    spin_until(node, lambda: len(received) == 3)


def test_order_of_one_publisher_is_kept(node, start_peer, peer_cluster):
    received = []
    node.create_subscription(String, "count", lambda m: received.append(int(m.data)), 1000)
    start_peer(count_to, 1000, cluster=peer_cluster)
    spin_until(node, lambda: len(received) == 1000)
    assert received == list(range(1000))


def count_to(limit: int) -> None:
    with peer_node() as node:
        publisher = node.create_publisher(String, "count", 1000)
        spin_until(node, publisher.get_subscription_count)
        for number in range(limit):
            publisher.publish(String(data=str(number)))
        rclpy.spin(node)


def test_message_info(node):
    infos = []
    publisher = node.create_publisher(String, "chatter", 10)
    node.create_subscription(String, "chatter", lambda _, info: infos.append(info), 10)
    spin_until(node, publisher.get_subscription_count)
    before = node.get_clock().now().nanoseconds
    publisher.publish(String())
    publisher.publish(String())
    spin_until(node, lambda: len(infos) == 2)
    after = node.get_clock().now().nanoseconds
    for info in infos:
        assert before <= info["source_timestamp"] <= info["received_timestamp"] <= after
    numbers = [info["publication_sequence_number"] for info in infos]
    assert numbers[1] == numbers[0] + 1


def test_all_acknowledged(node, start_peer, peer_cluster):
    """Wait until every reliable reader has taken everything."""
    peer = start_peer(listen, cluster=peer_cluster)
    publisher = node.create_publisher(String, "chatter", 10)
    spin_until(node, publisher.get_subscription_count)
    peer.wait_for("ready")
    publisher.publish(String(data="x"))
    assert publisher.wait_for_all_acked()


def listen() -> None:
    with peer_node() as node:
        node.create_subscription(String, "chatter", lambda m: announce(f"heard {m.data}"), 10)
        spin_until(node, lambda: node.count_publishers("chatter"))
        announce("ready")
        rclpy.spin(node)


def test_different_types_on_one_topic_do_not_meet(node, start_peer, peer_cluster):
    strangers, friends = [], []
    node.create_subscription(String, "chatter", strangers.append, 10)
    node.create_subscription(String, "witness", friends.append, 10)
    peer = start_peer(publish_two_types, cluster=peer_cluster)
    spin_until(node, lambda: friends)
    peer.wait_for("0 readers of chatter")
    assert strangers == []


def publish_two_types() -> None:
    with peer_node() as node:
        other_type = node.create_publisher(UInt8MultiArray, "chatter", 10)
        same_type = node.create_publisher(String, "witness", 10)
        spin_until(node, same_type.get_subscription_count)
        announce(f"{other_type.get_subscription_count()} readers of chatter")
        other_type.publish(UInt8MultiArray(data=[1, 2, 3]))
        same_type.publish(String())
        rclpy.spin(node)
