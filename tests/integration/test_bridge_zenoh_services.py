# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Services, parameters and actions through a bridge to rmw_zenoh."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

import pytest

from rmw_manycore_bridge.outside.types import hash_of
from rmw_manycore_py.routes.route import action_routes, parameter_routes
from support import IS_MANYCORE, TIMEOUT_S, wait_until
from support.nodes.bridging import ZenohBridge
from support.nodes.ros import announce, peer_node, spin_until, type_of
from support.nodes.zenoh_peers import SET_BOOL, ask, sdk_call, sdk_list, sdk_serve
from support.processes.platforms import leftovers, unique_platform

pytestmark = [
    pytest.mark.integration,
    pytest.mark.needs("zenoh", "zenoh_ros2_sdk", "xxhash"),
    pytest.mark.skipif(not IS_MANYCORE, reason="the bridge is part of rmw_manycore"),
]

FIBONACCI = "test_msgs/action/Fibonacci"


@pytest.fixture
def zenoh(start, platform) -> ZenohBridge:
    return ZenohBridge(start, platform)


def serve(answers: bool) -> None:
    """Serve SetBool, or block in the first request."""
    with peer_node("server") as node:

        def answer(request: Any, response: Any) -> Any:
            announce("asked")
            if not answers:
                spin_until(node, lambda: False, 1e6)
            response.success, response.message = request.data, "served"
            return response

        node.create_service(type_of(SET_BOOL), "/lamp", answer)
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
            spin_until(node, future.done)
            announce(f"answer {future.result().success} {future.result().message}")
        spin_until(node, lambda: not client.service_is_ready())
        announce("no service")


def test_a_service_of_the_platform_is_called(zenoh) -> None:
    zenoh.run(zenoh.route("inward", "/lamp", SET_BOOL))
    zenoh.inside(serve, True).wait_for("^serving$")
    caller = zenoh.outside(sdk_call, 3)
    for expected in ("True", "False", "True"):
        caller.wait_for(f"^answer {expected} served$")
    row = zenoh.row("inward", "/lamp")
    assert (row["messages"], row["timed_out"], row["unanswered"]) == (3, 0, 0)


def test_a_service_outside_is_called(zenoh) -> None:
    zenoh.run(zenoh.route("outward", "/lamp", SET_BOOL))
    server = zenoh.outside(sdk_serve, True)
    caller = zenoh.inside(call, 3)
    for expected in ("True", "False", "True"):
        caller.wait_for(f"^answer {expected} served$")
    server.kill()
    caller.wait_for("^no service$")


def test_a_server_outside_that_is_killed(zenoh) -> None:
    zenoh.run(zenoh.route("outward", "/lamp", SET_BOOL))
    server = zenoh.outside(sdk_serve, False)
    caller = zenoh.inside(call, 1)
    server.wait_for("^asked$")
    server.kill()
    caller.wait_for("^answer False bridge: the server is gone$")
    assert zenoh.row("outward", "/lamp")["unanswered"] == 1


def test_a_server_of_the_platform_that_never_answers(zenoh) -> None:
    zenoh.run(zenoh.route("inward", "/lamp", SET_BOOL, timeout_s=0.5))
    zenoh.inside(serve, False).wait_for("^serving$")
    zenoh.outside(sdk_call, 1).wait_for(r"^answer False bridge: no reply within 0\.5 s$")


def have_a_parameter() -> None:
    with peer_node("lamp") as node:
        node.declare_parameter("level", 7)
        announce("declared")
        spin_until(node, lambda: False, 1e6)


def test_parameters_of_a_node(zenoh) -> None:
    node = zenoh.route("inward", "/lamp", "")
    zenoh.run(*parameter_routes(node))
    zenoh.inside(have_a_parameter).wait_for("^declared$")
    service = "rcl_interfaces/srv/GetParameters"
    shown = zenoh.outside(sdk_list).wait_for(r"^topics .*/lamp/get_parameters.*$").group()
    assert re.search(rf"'/lamp/get_parameters', \['{service}'\]", shown)
    zenoh.outside_of_domain(
        ask, zenoh.domain, "/lamp/get_parameters", service, hash_of(service), {"names": ["level"]}
    ).wait_for("^answer .*integer_value=7")


def test_a_gateway_of_services(zenoh, bridge) -> None:
    """A server in DDS, a client of rmw_zenoh, and the platform between them."""
    bridge.run(bridge.route("outward", "/lamp", SET_BOOL))
    zenoh.run(zenoh.route("inward", "/lamp", SET_BOOL))
    bridge.outside(serve, True).wait_for("^serving$")
    zenoh.outside(sdk_call, 1).wait_for("^answer True served$")


def test_a_gateway_of_services_the_other_way(zenoh, bridge) -> None:
    zenoh.run(zenoh.route("outward", "/lamp", SET_BOOL))
    bridge.run(bridge.route("inward", "/lamp", SET_BOOL))
    zenoh.outside(sdk_serve, True).wait_for("^serving$")
    bridge.outside(call, 1).wait_for("^answer True served$")


@pytest.fixture
def other_platform() -> Iterator[str]:
    name = unique_platform()
    yield name
    wait_until(lambda: not leftovers(name), f"{name} leaves nothing in /dev/shm")


def serve_action() -> None:
    """Serve Fibonacci."""
    from rclpy.action import ActionServer

    kind = type_of(FIBONACCI)
    with peer_node("counter") as node:

        def execute(goal: Any) -> Any:
            goal.publish_feedback(kind.Feedback(sequence=[0, 1]))
            goal.succeed()
            return kind.Result(sequence=[0, 1, 1])

        ActionServer(node, kind, "count", execute)
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
        result = sent.result().get_result_async()
        spin_until(node, result.done)
        announce(f"status {result.result().status} {list(result.result().result.sequence)}")
        spin_until(node, lambda: False, 1e6)


def test_an_action_between_two_platforms(other_platform, zenoh) -> None:
    there = zenoh.beside(other_platform)
    zenoh.run(*action_routes(zenoh.route("inward", "/count", FIBONACCI)))
    there.run(*action_routes(there.route("outward", "/count", FIBONACCI)))
    zenoh.inside(serve_action).wait_for("^serving$")
    sender = there.inside(send_goal)
    sender.wait_for(r"^feedback \[0, 1\]$")
    sender.wait_for(r"^status 4 \[0, 1, 1\]$")  # succeeded
