# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""History of services: a server keeps the last requests, a client the last responses."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest
import rclpy
from rclpy._rclpy_pybind11 import RCLError
from rclpy.node import Node
from rclpy.qos import HistoryPolicy, QoSProfile, ReliabilityPolicy
from std_msgs.msg import String
from test_msgs.srv import BasicTypes

from support import IS_MANYCORE, TIMEOUT_S
from support.nodes.ros import lost_messages, peer_node, spin_until

COUNT = 10
DEEP = QoSProfile(depth=100)
KEEP_ALL = QoSProfile(history=HistoryPolicy.KEEP_ALL, reliability=ReliabilityPolicy.RELIABLE)
DEPTHS = [1, 2, 3, 5]


class Server:
    """A server that answers with the number in the request, and records the numbers."""

    def __init__(self, node: Node, qos: QoSProfile, service: str = "mirror") -> None:
        self.numbers: list[int] = []
        node.create_service(BasicTypes, service, self._answer, qos_profile=qos)

    def _answer(self, request: Any, response: Any) -> Any:
        self.numbers.append(request.int64_value)
        response.int64_value = request.int64_value
        return response


def ask(client: Any, number: int) -> Any:
    return client.call_async(BasicTypes.Request(int64_value=number))


@pytest.fixture
def other_node(node) -> Iterator[Node]:
    """Yield a second node: one of the two is spun while the other's messages arrive."""
    other = rclpy.create_node("other")
    yield other
    other.destroy_node()


@pytest.mark.parametrize("depth", DEPTHS)
def test_a_server_keeps_the_last_requests(node, other_node, start_peer, peer_cluster, depth):
    server, sent = Server(node, QoSProfile(depth=depth)), []
    other_node.create_subscription(String, "sent", sent.append, 1)
    start_peer(ask_numbers, cluster=peer_cluster)
    spin_until(other_node, lambda: sent)
    spin_until(node, lambda: COUNT - 1 in server.numbers)
    client = other_node.create_client(BasicTypes, "mirror")
    assert client.wait_for_service(TIMEOUT_S)
    ask(client, COUNT)
    spin_until(node, lambda: COUNT in server.numbers)  # and nothing came before it
    assert server.numbers == list(range(COUNT - depth, COUNT + 1))
    if IS_MANYCORE:
        assert lost_messages("/mirror", "request") == COUNT - depth


def ask_numbers() -> None:
    """Send requests at once, then a message."""
    with peer_node() as node:
        client = node.create_client(BasicTypes, "mirror", qos_profile=DEEP)
        publisher = node.create_publisher(String, "sent", 1)
        assert client.wait_for_service(TIMEOUT_S)
        spin_until(node, publisher.get_subscription_count)
        for number in range(COUNT):
            ask(client, number)
        publisher.publish(String())
        rclpy.spin(node)


@pytest.mark.parametrize("depth", DEPTHS)
def test_a_client_keeps_the_last_replies(node, other_node, depth):
    server = Server(node, DEEP)
    client = other_node.create_client(BasicTypes, "mirror", qos_profile=QoSProfile(depth=depth))
    assert client.wait_for_service(TIMEOUT_S)
    answers = [ask(client, number) for number in range(COUNT)]
    spin_until(node, lambda: len(server.numbers) == COUNT)
    spin_until(other_node, answers[-1].done)
    answers.append(ask(client, COUNT))
    spin_until(node, lambda: len(server.numbers) == COUNT + 1)
    spin_until(other_node, answers[-1].done)
    answered = [number for number, answer in enumerate(answers) if answer.done()]
    assert answered == list(range(COUNT - depth, COUNT + 1))
    assert [answers[number].result().int64_value for number in answered] == answered
    if IS_MANYCORE:
        assert lost_messages("/mirror", "reply") == COUNT - depth


def test_keep_all_displaces_nothing(node, other_node):
    server, count = Server(node, KEEP_ALL), 200
    client = other_node.create_client(BasicTypes, "mirror", qos_profile=KEEP_ALL)
    assert client.wait_for_service(TIMEOUT_S)
    answers = [ask(client, number) for number in range(count)]
    spin_until(node, lambda: len(server.numbers) == count)
    spin_until(other_node, lambda: all(answer.done() for answer in answers))
    assert server.numbers == list(range(count))


@pytest.mark.skipif(not IS_MANYCORE, reason="sizes are of platforms")
def test_keep_all_fails_for_a_client_without_room(small_topic):
    node = rclpy.create_node("tester")
    server = Server(node, KEEP_ALL, small_topic)
    client = node.create_client(BasicTypes, small_topic, qos_profile=KEEP_ALL)
    assert client.wait_for_service(TIMEOUT_S)
    answers: list[Any] = []
    with pytest.raises(RCLError, match="has not taken its messages for 100 ms"):
        answers.extend(ask(client, number) for number in range(10_000))
    assert 10 < len(answers) < 200  # 8 KiB
    spin_until(node, lambda: all(answer.done() for answer in answers))
    assert server.numbers == list(range(len(answers)))
    node.destroy_node()
