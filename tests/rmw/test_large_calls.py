# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Requests, responses, feedback and results with large arrays, also with those of a record."""

from __future__ import annotations

import array
from typing import Any

import pytest
from nav_msgs.msg import OccupancyGrid
from nav_msgs.srv import GetMap, SetMap
from rclpy.action import ActionClient, ActionServer
from rclpy.node import Node
from test_msgs.action import Fibonacci

from support import IS_MANYCORE, TIMEOUT_S
from support.nodes.exchanging import in_record
from support.nodes.ros import peer_node, spin, spin_until

CELLS = 300_000
MAPS = 20  # more than the history of a topic, so that records are used again


def grid(seed: int) -> array.array[int]:
    return array.array("b", [(seed + i) % 100 for i in range(256)] * (CELLS // 256))


def serve() -> None:
    """Return each map that was set, from the request that held it."""
    kept: list[OccupancyGrid] = []

    def set_map(request: SetMap.Request, response: SetMap.Response) -> SetMap.Response:
        kept.append(request.map)
        response.success = True
        return response

    def get_map(_: GetMap.Request, response: GetMap.Response) -> GetMap.Response:
        response.map = kept.pop(0)
        return response

    with peer_node("maps") as node:
        node.create_service(SetMap, "set_map", set_map)
        node.create_service(GetMap, "get_map", get_map)
        spin(node)


def answer(node: Node, client: Any, request: Any) -> Any:
    assert client.wait_for_service(TIMEOUT_S)
    future = client.call_async(request)
    spin_until(node, future.done)
    return future.result()


@pytest.fixture
def maps(node: Node) -> list[OccupancyGrid]:
    """Return maps as they were taken from a topic; the later ones are still held."""
    taken: list[OccupancyGrid] = []
    publisher = node.create_publisher(OccupancyGrid, "map", 10)
    node.create_subscription(OccupancyGrid, "map", taken.append, 10)
    spin_until(node, publisher.get_subscription_count)
    for number in range(MAPS):
        message = OccupancyGrid()
        message.data = grid(number)
        publisher.publish(message)
        spin_until(node, lambda: len(taken) == number + 1)  # noqa: B023
    return taken


def test_requests_and_responses_carry_arrays_of_records(node, start_peer, peer_cluster, maps):
    assert any(in_record(one.data) for one in maps) == IS_MANYCORE
    start_peer(serve, cluster=peer_cluster)
    setter = node.create_client(SetMap, "set_map")
    getter = node.create_client(GetMap, "get_map")
    for one in maps:
        assert answer(node, setter, SetMap.Request(map=one)).success
    found = []
    while maps:  # each record is given back before the map returns
        maps.pop()
        found.append(answer(node, getter, GetMap.Request()).map)
    assert [one.data == grid(number) for number, one in enumerate(found)] == [True] * MAPS


def test_requests_in_flight_are_not_mixed(node, start_peer, peer_cluster, maps):
    start_peer(serve, cluster=peer_cluster)
    setter = node.create_client(SetMap, "set_map")
    assert setter.wait_for_service(TIMEOUT_S)
    futures = [setter.call_async(SetMap.Request(map=one)) for one in maps[:5]]
    for one in maps:  # after the call, the caller may change what it sent
        one.data[0] ^= 1
    spin_until(node, lambda: all(future.done() for future in futures))
    getter = node.create_client(GetMap, "get_map")
    found = [answer(node, getter, GetMap.Request()).map.data for _ in futures]
    assert found == [grid(number) for number in range(5)]


def test_feedback_and_results_carry_large_arrays(node):
    numbers = array.array("i", range(CELLS))

    def execute(goal: Any) -> Fibonacci.Result:
        goal.publish_feedback(Fibonacci.Feedback(sequence=numbers))
        goal.succeed()
        return Fibonacci.Result(sequence=numbers)

    server = ActionServer(node, Fibonacci, "large", execute)
    client = ActionClient(node, Fibonacci, "large")
    assert client.wait_for_server(TIMEOUT_S)
    feedback: list[Any] = []
    accepted = client.send_goal_async(
        Fibonacci.Goal(order=1), feedback_callback=lambda one: feedback.append(one.feedback)
    )
    spin_until(node, accepted.done)
    spin_until(node, lambda: feedback)  # rclpy drops feedback that arrives after the result
    finished = accepted.result().get_result_async()
    spin_until(node, finished.done)
    assert finished.result().result.sequence == numbers
    assert feedback[0].sequence == numbers
    client.destroy()
    server.destroy()
