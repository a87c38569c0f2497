# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Servers and callers of a service and an action, on either side of a bridge."""

from __future__ import annotations

import signal
import threading
from typing import Any

from support import TIMEOUT_S, wait_until
from support.nodes.ros import announce, peer_node, spin_until, type_of

SET_BOOL = "std_srvs/srv/SetBool"
FIBONACCI = "test_msgs/action/Fibonacci"


def serve(answers: bool) -> None:
    """Serve SetBool; unless `answers`, block in the first request."""
    with peer_node("server") as node:

        def answer(request: Any, response: Any) -> Any:
            announce("asked")
            if not answers:
                threading.Event().wait()
            response.success, response.message = request.data, "served"
            return response

        node.create_service(type_of(SET_BOOL), "/lamp", answer)
        # Fast DDS drops a response if it does not discover the client within 100 ms; not spun, the
        # node answers no request before.
        wait_until(lambda: node.count_clients("/lamp"), "the bridge's client is discovered")
        announce("serving")
        spin_until(node, lambda: False, 1e6)


def call(times: int) -> None:
    """Call SetBool, one call after the other."""
    with peer_node("caller") as node:
        kind = type_of(SET_BOOL)
        client = node.create_client(kind, "/lamp")
        assert client.wait_for_service(TIMEOUT_S)
        for number in range(times):
            future = client.call_async(kind.Request(data=number % 2 == 0))
            announce("called")
            spin_until(node, future.done)
            announce(f"answer {future.result().success} {future.result().message}")
        spin_until(node, lambda: not client.service_is_ready())
        announce("no service")


def count() -> None:
    """Serve Fibonacci with endless feedback; succeed on request, and let goals be canceled."""
    from rclpy.action import ActionServer, CancelResponse

    told: list[int] = []
    signal.signal(signal.SIGUSR1, lambda number, _: told.append(number))
    kind = type_of(FIBONACCI)
    goals: list[Any] = []
    with peer_node("counter") as node:

        def accepted(goal: Any) -> None:
            announce("executing")
            goals.append(goal)

        def go_on() -> None:
            for goal in goals:
                goal.publish_feedback(kind.Feedback(sequence=[0, 1]))
            if goals and (told or goals[0].is_cancel_requested):
                goals.pop(0).execute()

        def end(goal: Any) -> Any:
            if goal.is_cancel_requested:
                goal.canceled()
            else:
                goal.succeed()
            return kind.Result(sequence=[0, 1, 1])

        ActionServer(
            *(node, kind, "count", end),
            handle_accepted_callback=accepted,
            cancel_callback=lambda _: CancelResponse.ACCEPT,
        )
        node.create_timer(0.02, go_on)
        for service in ("send_goal", "get_result"):  # as in `serve`
            name = f"/count/_action/{service}"
            wait_until(lambda name=name: node.count_clients(name), f"a client of {name}")
        announce("serving")
        spin_until(node, lambda: False, 1e6)


def send_goal(cancels: bool = False) -> None:
    """Send a goal, and print its feedback and result; cancel it first if asked to."""
    from rclpy.action import ActionClient

    kind = type_of(FIBONACCI)
    with peer_node("sender") as node:
        client = ActionClient(node, kind, "count")
        spin_until(node, client.server_is_ready)
        heard: list[Any] = []

        def feedback(message: Any) -> None:
            heard.append(message)
            announce(f"feedback {list(message.feedback.sequence)}")

        sent = client.send_goal_async(kind.Goal(order=3), feedback)
        spin_until(node, sent.done)
        announce(f"accepted {sent.result().accepted}")
        result = sent.result().get_result_async()
        announce("asked for the result")
        if cancels:
            spin_until(node, lambda: heard)
            asked = sent.result().cancel_goal_async()
            spin_until(node, asked.done)
            announce(f"canceling {len(asked.result().goals_canceling)}")
        spin_until(node, result.done)
        announce(f"status {result.result().status} {list(result.result().result.sequence)}")
