# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Actions: goals, feedback, results, cancelling, several clients."""

from __future__ import annotations

import pytest
import rclpy
from action_msgs.msg import GoalStatus
from rclpy.action import ActionClient, ActionServer, CancelResponse, GoalResponse
from rclpy.node import Node
from rclpy.task import Future
from test_msgs.action import Fibonacci

from support import TIMEOUT_S
from support.nodes.ros import peer_node, spin_until
from support.peers.programs import forked_example

FAST = ("--ros-args", "-p", "rate_hz:=50.0")


@pytest.fixture
def client(node: Node, start, peer_cluster) -> ActionClient:
    """Start the example server and return a client of it."""
    start(forked_example("fibonacci_server", *FAST), peer_cluster)
    client = ActionClient(node, Fibonacci, "fibonacci")
    assert client.wait_for_server(TIMEOUT_S)
    return client


def send(node, client, order, feedback=None):
    accepted = client.send_goal_async(Fibonacci.Goal(order=order), feedback_callback=feedback)
    spin_until(node, accepted.done)
    return accepted.result()


def result_of(node, goal):
    finished = goal.get_result_async()
    spin_until(node, finished.done)
    return finished.result()


def test_goal_feedback_and_result(node, client):
    """rclpy drops feedback that arrives after the result, so all feedback comes first."""
    steps = []
    goal = send(node, client, 5, lambda message: steps.append(list(message.feedback.sequence)))
    spin_until(node, lambda: len(steps) == 4)
    assert steps[-1] == [0, 1, 1, 2, 3, 5]
    result = result_of(node, goal)
    assert result.status == GoalStatus.STATUS_SUCCEEDED
    assert list(result.result.sequence) == [0, 1, 1, 2, 3, 5]


def test_cancel(node, start_peer, peer_cluster):
    start_peer(compute_until_cancelled, cluster=peer_cluster)
    client = ActionClient(node, Fibonacci, "fibonacci")
    assert client.wait_for_server(TIMEOUT_S)
    goal = send(node, client, 40)
    cancelled = goal.cancel_goal_async()
    spin_until(node, cancelled.done)
    assert len(cancelled.result().goals_canceling) == 1
    assert result_of(node, goal).status == GoalStatus.STATUS_CANCELED


def compute_until_cancelled() -> None:
    with peer_node() as node:
        cancelled = Future()

        def cancel(_) -> CancelResponse:
            cancelled.set_result(None)
            return CancelResponse.ACCEPT

        async def compute(goal) -> Fibonacci.Result:
            await cancelled
            goal.canceled()
            return Fibonacci.Result()

        ActionServer(node, Fibonacci, "fibonacci", compute, cancel_callback=cancel)
        rclpy.spin(node)


def test_result_of_a_goal_that_ended_long_ago(node, client):
    """The result is requested after the server has it, and is still available."""
    goal = send(node, client, 2)
    spin_until(node, lambda: goal.status == GoalStatus.STATUS_SUCCEEDED)
    assert list(result_of(node, goal).result.sequence) == [0, 1, 1]


def test_several_goals_at_once(node, client):
    orders = [2, 3, 4, 5]
    goals = [send(node, client, order) for order in orders]
    lengths = [len(result_of(node, goal).result.sequence) for goal in goals]
    assert lengths == [3, 4, 5, 6]


def test_several_clients(node, start, client):
    others = [
        start(forked_example("fibonacci_client", "--ros-args", "-r", f"__node:=client_{n}"), n)
        for n in (1, 2)
    ]
    assert len(result_of(node, send(node, client, 6)).result.sequence) == 7
    for other in others:
        other.wait_for(r"goal 1 succeeded: \[0, 1, 1, 2, 3, 5\]")


def test_rejected_goal(node, start_peer, peer_cluster):
    start_peer(reject, cluster=peer_cluster)
    client = ActionClient(node, Fibonacci, "fibonacci")
    assert client.wait_for_server(TIMEOUT_S)
    assert not send(node, client, 5).accepted


def reject() -> None:
    with peer_node() as node:
        ActionServer(
            node,
            Fibonacci,
            "fibonacci",
            execute_callback=lambda goal: Fibonacci.Result(),
            goal_callback=lambda goal: GoalResponse.REJECT,
        )
        spin_until(node, lambda: False, timeout_s=600)


def test_server_goes_away(node, start, peer_cluster):
    server = start(forked_example("fibonacci_server", *FAST), peer_cluster)
    client = ActionClient(node, Fibonacci, "fibonacci")
    assert client.wait_for_server(TIMEOUT_S)
    result_of(node, send(node, client, 1))  # the server spins
    assert server.stop_node()
    spin_until(node, lambda: not client.server_is_ready())
