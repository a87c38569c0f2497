# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Services, parameters and actions through the bridge, in both directions."""

from __future__ import annotations

import re
import signal
from typing import Any

import pytest

from rmw_manycore_py.routes.route import action_routes, parameter_routes
from support import IS_MANYCORE, TIMEOUT_S
from support.nodes.bridging import Bridge
from support.nodes.ros import announce, peer_node, spin_until, type_of
from support.nodes.serving import FIBONACCI, SET_BOOL, call, count, send_goal, serve

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="the bridge is part of rmw_manycore"),
]

MANY = 1000  # requests: many more than the bridge takes before it looks at the graph


@pytest.fixture(params=["inward", "outward"])
def direction(request) -> str:
    return str(request.param)


def sides(bridge: Bridge, direction: str) -> tuple[Any, Any]:
    """Return the functions that start a server and its client."""
    if direction == "inward":
        return bridge.inside, bridge.outside
    return bridge.outside, bridge.inside


def test_a_service_is_called(bridge, direction) -> None:
    bridge.run(bridge.route(direction, "/lamp", SET_BOOL))
    server, client = sides(bridge, direction)
    serving = server(serve, True)
    caller = client(call, 3)
    for expected in ("True", "False", "True"):
        caller.wait_for(f"^answer {expected} served$")
    serving.stop()
    caller.wait_for("^no service$")
    row = bridge.row(direction, "/lamp")
    assert (row["messages"], row["timed_out"], row["unanswered"]) == (3, 0, 0)


def test_a_server_that_never_answers(bridge, direction) -> None:
    bridge.run(bridge.route(direction, "/lamp", SET_BOOL, timeout_s=0.5))
    server, client = sides(bridge, direction)
    server(serve, False)
    client(call, 1).wait_for(r"^answer False bridge: no reply within 0\.5 s$")
    assert bridge.row(direction, "/lamp")["timed_out"] == 1


def test_a_server_that_dies(bridge) -> None:
    bridge.run(bridge.route("inward", "/lamp", SET_BOOL))
    serving = bridge.inside(serve, False)
    caller = bridge.outside(call, 1)
    serving.wait_for("^asked$")
    serving.kill()
    caller.wait_for("^answer False bridge: the server is gone$")
    caller.wait_for("^no service$")
    assert bridge.row("inward", "/lamp")["unanswered"] == 1


def call_at_once(times: int) -> None:
    """On request call SetBool so often without waiting; print how many responses arrived."""
    from rclpy.qos import QoSProfile

    told: list[int] = []
    signal.signal(signal.SIGUSR1, lambda number, _: told.append(number))
    with peer_node("caller") as node:
        kind = type_of(SET_BOOL)
        client = node.create_client(kind, "/lamp", qos_profile=QoSProfile(depth=times))
        assert client.wait_for_service(TIMEOUT_S)
        announce("ready")
        spin_until(node, lambda: told)
        futures = [client.call_async(kind.Request(data=True)) for _ in range(times)]
        announce("called")
        spin_until(node, lambda: all(future.done() for future in futures))
        reasons = {future.result().message for future in futures}
        announce(f"answered {reasons}")


def test_requests_that_were_not_read_when_the_server_went(bridge) -> None:
    process = bridge.run(bridge.route("outward", "/lamp", SET_BOOL))["outward"]
    server = bridge.outside(serve, True)
    caller = bridge.inside(call_at_once, MANY)
    caller.wait_for("^ready$")
    process.signal(signal.SIGSTOP)  # so that it finds them all at once
    caller.signal(signal.SIGUSR1)
    caller.wait_for("^called$")
    server.stop()
    process.signal(signal.SIGCONT)
    caller.wait_for("^answered {'bridge: the server is gone'}$")
    assert bridge.row("outward", "/lamp")["unanswered"] == MANY


def serve_as(type_name: str, reliability: str) -> None:
    """Serve /lamp with another type or QoS than its callers use."""
    from rclpy.qos import QoSProfile, ReliabilityPolicy

    with peer_node("server") as node:
        profile = QoSProfile(depth=10, reliability=ReliabilityPolicy[reliability])
        kind = type_of(type_name)
        node.create_service(kind, "/lamp", lambda _, response: response, qos_profile=profile)
        announce("serving")
        spin_until(node, lambda: False, 1e6)


def test_a_server_of_another_type_is_reported(bridge, direction) -> None:
    process = bridge.run(bridge.route(direction, "/lamp", SET_BOOL))[direction]
    server, client = sides(bridge, direction)
    where = "inside" if direction == "inward" else "outside"
    said = f"^/lamp: is std_srvs/srv/Trigger {where}, not {SET_BOOL}$"
    odd = server(serve_as, "std_srvs/srv/Trigger", "RELIABLE")
    process.wait_for(said)
    assert bridge.row(direction, "/lamp")["state"] == "failed"
    server(serve, True).wait_for("^serving$")
    client(call, 1).wait_for("^answer True served$")  # the other server does no harm
    odd.stop()
    assert len(re.findall(said, process.output, re.MULTILINE)) == 1


def test_a_server_that_does_not_match_is_reported(bridge) -> None:
    process = bridge.run(bridge.route("outward", "/lamp", SET_BOOL))["outward"]
    odd = bridge.outside(serve_as, SET_BOOL, "BEST_EFFORT")
    process.wait_for("^/lamp: has a server outside that DDS does not match: its QoS may not fit$")
    assert bridge.row("outward", "/lamp")["state"] == "failed"
    odd.stop()
    bridge.outside(serve, True).wait_for("^serving$")
    bridge.inside(call, 1).wait_for("^answer True served$")


def has_parameters() -> None:
    """Declare a parameter, and print when it is set."""
    with peer_node("tuned") as node:
        node.declare_parameter("gain", 1)
        announce("ready")
        spin_until(node, lambda: node.get_parameter("gain").value == 7)
        announce("gain is 7")
        spin_until(node, lambda: False, 1e6)


def tune() -> None:
    """List, get and set the parameters of the node on the other side."""
    from rclpy.parameter import Parameter
    from rclpy.parameter_client import AsyncParameterClient

    with peer_node("tuner") as node:
        # Tools require that the node itself is in the graph.
        spin_until(node, lambda: ("tuned", "/") in node.get_node_names_and_namespaces())
        client = AsyncParameterClient(node, "/tuned")
        assert client.wait_for_services(TIMEOUT_S)
        listed, got = client.list_parameters([], 10), client.get_parameters(["gain"])
        spin_until(node, lambda: listed.done() and got.done())
        announce(f"listed {'gain' in listed.result().result.names}")
        announce(f"got {got.result().values[0].integer_value}")
        done = client.set_parameters([Parameter("gain", value=7)])
        spin_until(node, done.done)
        announce(f"set {done.result().results[0].successful}")


def wait_until_it_is_gone() -> None:
    """Print when the node on the other side appears and disappears."""
    with peer_node("watcher") as node:
        spin_until(node, lambda: "tuned" in node.get_node_names())
        announce("there")
        spin_until(node, lambda: "tuned" not in node.get_node_names())
        announce("gone")


def test_parameters_from_outside(bridge) -> None:
    bridge.run(*parameter_routes(bridge.route("inward", "/tuned", "")))
    tuned = bridge.inside(has_parameters)
    tuner = bridge.outside(tune)
    for line in ("listed True", "got 1", "set True"):
        tuner.wait_for(f"^{line}$")
    tuned.wait_for("^gain is 7$")
    watcher = bridge.outside(wait_until_it_is_gone)
    watcher.wait_for("^there$")
    tuned.stop()
    watcher.wait_for("^gone$")


def test_an_action(bridge, direction) -> None:
    bridge.run(*action_routes(bridge.route(direction, "/count", FIBONACCI)))
    server, client = sides(bridge, direction)
    serving = server(count)
    sender = client(send_goal)
    sender.wait_for("^accepted True$")
    sender.wait_for(r"^feedback \[0, 1\]$")
    serving.signal(signal.SIGUSR1)
    sender.wait_for(r"^status 4 \[0, 1, 1\]$")  # succeeded


def test_an_action_server_that_dies(bridge) -> None:
    bridge.run(*action_routes(bridge.route("inward", "/count", FIBONACCI)))
    serving = bridge.inside(count)
    sender = bridge.outside(send_goal)
    serving.wait_for("^executing$")
    sender.wait_for("^asked for the result$")
    serving.kill()
    sender.wait_for(r"^status 0 \[\]$")  # unknown
