# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Servers and callers of a service and an action, on either side of a bridge."""

from __future__ import annotations

import signal
import threading
import time
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
    """Serve Fibonacci with endless feedback; succeed on request."""
    from rclpy.action import ActionServer

    told: list[int] = []
    signal.signal(signal.SIGUSR1, lambda number, _: told.append(number))
    kind = type_of(FIBONACCI)
    with peer_node("counter") as node:

        def execute(goal: Any) -> Any:
            announce("executing")
            while not told:
                goal.publish_feedback(kind.Feedback(sequence=[0, 1]))
                time.sleep(0.02)  # like an action that takes long
            goal.succeed()
            return kind.Result(sequence=[0, 1, 1])

        ActionServer(node, kind, "count", execute)
        for service in ("send_goal", "get_result"):  # as in `serve`
            name = f"/count/_action/{service}"
            wait_until(lambda name=name: node.count_clients(name), f"a client of {name}")
        announce("serving")
        spin_until(node, lambda: False, 1e6)


def send_goal() -> None:
    """Send a goal, and print its feedback and result."""
    from rclpy.action import ActionClient

    kind = type_of(FIBONACCI)
    with peer_node("sender") as node:
        client = ActionClient(node, kind, "count")
        spin_until(node, client.server_is_ready)
        sent = client.send_goal_async(
            kind.Goal(order=3),
            lambda message: announce(f"feedback {list(message.feedback.sequence)}"),
        )
        spin_until(node, sent.done)
        announce(f"accepted {sent.result().accepted}")
        result = sent.result().get_result_async()
        announce("asked for the result")
        spin_until(node, result.done)
        announce(f"status {result.result().status} {list(result.result().result.sequence)}")
