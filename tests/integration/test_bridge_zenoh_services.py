# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Services, parameters and actions through a bridge to rmw_zenoh."""

from __future__ import annotations

import re
import signal
from pathlib import Path

import pytest

from rmw_manycore_bridge.outside.types import hash_of
from rmw_manycore_py.routes.plan import Plan
from rmw_manycore_py.routes.route import action_routes, parameter_routes
from support import IS_MANYCORE, wait_until
from support.nodes.bridging import ZenohBridge
from support.nodes.ros import announce, peer_node, spin_until
from support.nodes.serving import FIBONACCI, SET_BOOL, call, count, send_goal, serve
from support.nodes.zenoh_actions import sdk_count, sdk_send_goal
from support.nodes.zenoh_peers import ask, sdk_call, sdk_list, sdk_serve

pytestmark = [
    pytest.mark.integration,
    pytest.mark.needs("zenoh", "zenoh_ros2_sdk", "xxhash"),
    pytest.mark.skipif(not IS_MANYCORE, reason="the bridge is part of rmw_manycore"),
]


@pytest.fixture
def zenoh(start, platform) -> ZenohBridge:
    return ZenohBridge(start, platform)


def test_a_service_of_the_platform_is_called(zenoh) -> None:
    zenoh.run(zenoh.route("inward", "/lamp", SET_BOOL))
    zenoh.inside(serve, True).wait_for("^serving$")
    caller = zenoh.outside(sdk_call, 3)
    for expected in ("True", "False", "True"):
        caller.wait_for(f"^answer {expected} served$")
    # A response is counted once it is sent.
    wait_until(lambda: zenoh.row("inward", "/lamp")["messages"] == 3, "all are counted")
    row = zenoh.row("inward", "/lamp")
    assert (row["timed_out"], row["unanswered"]) == (0, 0)


def test_a_service_outside_is_called(zenoh) -> None:
    zenoh.run(zenoh.route("outward", "/lamp", SET_BOOL))
    server = zenoh.outside(sdk_serve, True)
    server.wait_for("^serving$")  # it announces its service before it has one
    caller = zenoh.inside(call, 3)
    for expected in ("True", "False", "True"):
        caller.wait_for(f"^answer {expected} served$")
    server.kill()
    caller.wait_for("^no service$")


def test_a_server_outside_that_is_killed(zenoh) -> None:
    zenoh.run(zenoh.route("outward", "/lamp", SET_BOOL))
    server = zenoh.outside(sdk_serve, False)
    server.wait_for("^serving$")  # it announces its service before it has one
    caller = zenoh.inside(call, 1)
    server.wait_for("^asked$")
    server.kill()
    caller.wait_for("^answer False bridge: the server is gone$")
    assert zenoh.row("outward", "/lamp")["unanswered"] == 1


def test_a_server_of_the_platform_that_never_answers(zenoh) -> None:
    route = zenoh.route("inward", "/lamp", SET_BOOL, timeout_s=0.5)
    process = zenoh.run_unforked(Plan(zenoh.platform, (route,), zenoh.settings), "inward")
    zenoh.inside(serve, False).wait_for("^serving$")
    zenoh.outside(sdk_call, 1).wait_for(r"^answer False bridge: no reply within 0\.5 s$")
    assert "rclpy" not in Path(f"/proc/{process.pid}/maps").read_text()


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


def test_an_action_between_two_platforms(other_platform, zenoh) -> None:
    there = zenoh.beside(other_platform)
    zenoh.run(*action_routes(zenoh.route("inward", "/count", FIBONACCI)))
    there.run(*action_routes(there.route("outward", "/count", FIBONACCI)))
    server = zenoh.inside(count)
    sender = there.inside(send_goal)
    sender.wait_for(r"^feedback \[0, 1\]$")
    server.signal(signal.SIGUSR1)
    sender.wait_for(r"^status 4 \[0, 1, 1\]$")  # succeeded


@pytest.mark.parametrize("cancels", [False, True])
def test_an_action_of_the_platform_with_a_foreign_client(zenoh, cancels) -> None:
    zenoh.run(*action_routes(zenoh.route("inward", "/count", FIBONACCI)))
    server, sender = zenoh.inside(count), zenoh.outside(sdk_send_goal, cancels)
    sender.wait_for("^accepted True$")
    sender.wait_for(r"^feedback \[0, 1\]$")
    if cancels:
        sender.wait_for("^canceling 1$")
    else:
        server.signal(signal.SIGUSR1)
    end = 5 if cancels else 4  # canceled, succeeded
    sender.wait_for(rf"^status {end} \[0, 1, 1\]$")


def test_a_foreign_action_server(zenoh) -> None:
    zenoh.run(*action_routes(zenoh.route("outward", "/count", FIBONACCI)))
    server, sender = zenoh.outside(sdk_count), zenoh.inside(send_goal, True)
    server.wait_for("^order 3$")
    sender.wait_for(r"^feedback \[0, 1\]$")
    sender.wait_for("^canceling 1$")
    sender.wait_for(r"^status 5 \[0, 1\]$")
