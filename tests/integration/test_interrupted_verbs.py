# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Ctrl-C in verbs that wait: for an answer, a server, a subscription or a message."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
from rclpy.duration import Duration

from rmw_manycore_py.errors import EXIT_INTERRUPTED
from support import IS_MANYCORE
from support.nodes.bridging import OUTSIDE
from support.nodes.ros import announce, peer_node
from support.peers.programs import forked_manycore
from support.processes.commands import manycore_command, peer_command

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="manycore is about rmw_manycore"),
]

SPEAKER = ("demo", "demo::Speaker")
STRING = ("/none", "std_msgs/msg/String")
FIBONACCI = ("/none", "test_msgs/action/Fibonacci", "{order: 1}")
SWITCH = ("std_srvs/srv/SetBool", "{data: true}")


def hung() -> None:
    """Announce each request, and leave it without an answer until the next line of input."""
    import rclpy
    from composition_interfaces.srv import ListNodes, LoadNode, UnloadNode
    from lifecycle_msgs.srv import ChangeState, GetAvailableTransitions, GetState
    from rcl_interfaces import srv
    from std_srvs.srv import SetBool

    types = {
        "get_parameters": srv.GetParameters,
        "get_parameter_types": srv.GetParameterTypes,
        "set_parameters": srv.SetParameters,
        "set_parameters_atomically": srv.SetParametersAtomically,
        "list_parameters": srv.ListParameters,
        "describe_parameters": srv.DescribeParameters,
        "get_state": GetState,
        "get_available_transitions": GetAvailableTransitions,
        "change_state": ChangeState,
        "_container/list_nodes": ListNodes,
        "_container/load_node": LoadNode,
        "_container/unload_node": UnloadNode,
        "switch": SetBool,
    }

    def leave(_request, response):
        announce("asked")
        sys.stdin.readline()
        return response

    with peer_node("hung", start_parameter_services=False) as node:
        for name, service_type in types.items():
            node.create_service(service_type, f"~/{name}", leave)
        announce("ready")
        rclpy.spin(node)


@pytest.fixture
def interrupted(start):
    """Return a function that interrupts a verb while its node is at work, and checks its end."""
    node = start(peer_command(hung))
    node.wait_for("ready")

    def interrupt(*words: object) -> str:
        verb = start(forked_manycore(*words))
        node.wait_for("^asked$")
        assert verb.stop() == EXIT_INTERRUPTED, verb
        assert "Traceback" not in verb.output, verb
        node.say("next")
        return verb.output

    return interrupt


def test_parameters_of_a_hung_node(interrupted, tmp_path: Path) -> None:
    file = tmp_path / "hung.yaml"
    file.write_text("/**: {ros__parameters: {gain: 1.5}}")
    for words in (
        ("get", "/hung", "gain"),
        ("set", "/hung", "gain", "1.5"),
        ("delete", "/hung", "gain"),
        ("describe", "/hung", "gain"),
        ("dump", "/hung"),
        ("list", "/hung"),
        ("load", "/hung", file),
    ):
        assert interrupted("param", *words) == ""


def test_lifecycle_of_a_hung_node(interrupted) -> None:
    for words in (("get", "/hung"), ("list", "/hung"), ("set", "/hung", "configure")):
        assert interrupted("lifecycle", *words) == ""


def test_components_of_a_hung_container(interrupted) -> None:
    for words in (("list",), ("load", "/hung", *SPEAKER), ("unload", "/hung", "1")):
        assert interrupted("component", *words) == ""


def test_calls_of_a_hung_server(interrupted) -> None:
    assert "response:" not in interrupted("service", "call", "/hung/switch", *SWITCH)


@pytest.mark.parametrize(
    ("words", "line"),
    [
        (("service", "call", "/none", *SWITCH), "waiting for service"),
        (("action", "send_goal", *FIBONACCI), "Waiting for an action server"),
        (("topic", "pub", "--once", *STRING), "Waiting for at least 1 matching"),
        (("topic", "pub", "-t", "5", "-w", "2", *STRING), "Waiting for at least 2 matching"),
        (("topic", "echo", "--once", *STRING), "does not appear to be published yet"),
    ],
    ids=lambda words: " ".join(words[:2]) if isinstance(words, tuple) else "",
)
def test_verbs_that_wait_for_another_node(start, words: tuple[str, ...], line: str) -> None:
    verb = start(forked_manycore(*words))
    verb.wait_for(line)
    assert verb.stop() == EXIT_INTERRUPTED, verb
    assert "Traceback" not in verb.output, verb


def watch_for_a_verb() -> None:
    """Announce the node of a verb; its name is only known to begin like this."""
    with peer_node() as node:
        while not any(name.startswith("_manycore_") for name in node.get_node_names()):
            node.get_clock().sleep_for(Duration(seconds=0.05))
        announce("seen")


def test_a_verb_that_waits_for_a_message_outside(start) -> None:
    watcher = start(peer_command(watch_for_a_verb), **OUTSIDE)
    verb = start(manycore_command("topic", "echo", "--outside", "--once", *STRING))
    watcher.wait_for("^seen$")
    assert verb.stop() == EXIT_INTERRUPTED, verb
    assert "Traceback" not in verb.output, verb


def test_verbs_that_run_until_ctrl_c(start) -> None:
    pub = start(forked_manycore("topic", "pub", "-r", "50", *STRING))
    pub.wait_for("^publishing #2")
    echo = start(forked_manycore("topic", "echo", "--timeout", "600", *STRING))
    echo.wait_for("^---$")
    assert [program.stop() for program in (echo, pub)] == [0, 0]
