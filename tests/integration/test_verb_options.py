# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Options of `ros2` under `manycore`, on real nodes, with the formats of ros2cli 0.32."""

from __future__ import annotations

import json
from contextlib import suppress

import pytest

from support import IS_MANYCORE
from support.nodes.ros import announce, peer_node
from support.peers.programs import forked_example, forked_manycore
from support.processes.commands import manycore_command, peer_command

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="manycore is about rmw_manycore"),
]


@pytest.fixture
def manycore(start):
    """Return a function that runs a verb and returns its output."""

    def call(*words: str, status: int = 0, text: str | None = None) -> str:
        program = start(forked_manycore(*words))
        if text is not None:
            for tell in (lambda: program.say(text), program.close_input):
                with suppress(BrokenPipeError):  # it has refused its options, and ended
                    tell()
        assert program.wait() == status, program
        return program.output

    return call


def a_bit_of_everything() -> None:
    """Serve topics, parameters, and a service with introspection."""
    import rclpy
    from rclpy.qos import qos_profile_system_default
    from rclpy.service_introspection import ServiceIntrospectionState
    from std_msgs.msg import Float64MultiArray, String
    from std_srvs.srv import SetBool

    with peer_node("filter") as node:
        node.declare_parameter("gain", 2.5)
        node.declare_parameter("limits.low", 1)
        node.declare_parameter("name", "left")
        talk = node.create_publisher(String, "chatter", 10)
        array = node.create_publisher(Float64MultiArray, "array", 10)
        hidden = node.create_publisher(String, "_hidden", 10)

        def publish() -> None:
            talk.publish(String(data="it is: 'x'"))
            array.publish(Float64MultiArray(data=[1.0, 2.5]))
            hidden.publish(String(data="seen"))

        def switch(request, response):
            response.success, response.message = True, "on" if request.data else "off"
            return response

        server = node.create_service(SetBool, "switch", switch)
        server.configure_introspection(
            node.get_clock(), qos_profile_system_default, ServiceIntrospectionState.CONTENTS
        )
        node.create_timer(0.05, publish)
        announce("ready")
        rclpy.spin(node)


@pytest.fixture
def running(start):
    node = start(peer_command(a_bit_of_everything))
    node.wait_for("ready")
    return node


def test_topics_with_the_options_of_ros2(running, manycore) -> None:
    looks = ("--no-daemon", "--spin-time", "1", "-s")
    assert manycore("topic", "list", *looks).splitlines()[:2] == ["/array", "/chatter"]
    assert "/_hidden" in manycore("topic", "--include-hidden-topics", "list").splitlines()
    assert manycore("topic", "list", "-v", "-c", *looks) == manycore("topic", "list", "-c")
    assert "Unknown topic '/chattr'; did you mean '/chatter'?" in manycore(
        "topic", "info", "/chattr", status=1
    )


def test_echo_with_the_options_of_ros2(running, start, manycore) -> None:
    once = ("topic", "echo", "--once", "--no-daemon", "--spin-time", "1")
    whole = manycore(*once, "/array", "--qos-profile", "default", "--flow-style").splitlines()
    assert whole == ["layout:", "  dim: []", "  data_offset: 0", "data: [1.0, 2.5]", "---"]
    # A field that is no message is printed with Python's str(): no quotes, also with --csv.
    for style in ((), ("--csv",), ("--no-str",)):
        assert manycore(*once, "/chatter", "--field", "data", *style) == "it is: 'x'\n---"
    assert manycore(*once, "/array", "--field", "data") == "array('d', [1.0, 2.5])\n---"
    liveliness = ("--qos-liveliness", "manual_by_topic")
    never = start(forked_manycore("topic", "echo", "/chatter", *liveliness))
    never.wait_for("incompatible policy: LIVELINESS")
    assert never.stop() == 0
    refused = manycore(*once, "/chatter", "--qos-profile", "fast", status=2)
    assert "'fast' is not one of 'unknown', 'default', 'system_default', 'sensor_data'" in refused


def test_meters_wait_for_a_topic(start, manycore) -> None:
    hz = start(forked_manycore("topic", "hz", "/chatter"))
    hz.wait_for(r"^WARNING: topic \[/chatter\] does not appear to be published yet$")
    bw = start(forked_manycore("topic", "bw", "/chatter"))
    bw.wait_for("WARNING")
    echo = start(forked_manycore("topic", "echo", "/chatter", "std_msgs/msg/String"))
    echo.wait_for(r"^WARNING: topic \[/chatter\] does not appear to be published yet$")
    start(peer_command(a_bit_of_everything)).wait_for("ready")
    hz.wait_for(r"^average rate: \d+\.\d{3}$")
    bw.wait_for(r"^Subscribed to \[/chatter\]$")
    bw.wait_for(r"^\d+ B/s from \d+ messages$")
    assert [meter.stop() for meter in (hz, bw, echo)] == [0, 0, 0]


def test_simulated_time_is_that_of_the_clock(start) -> None:
    stamped = ("/stamped", "std_msgs/msg/Header")
    pub = start(forked_manycore("topic", "pub", "-s", *stamped, "{stamp: now}"))
    echo = start(forked_manycore("topic", "echo", *stamped, "--field", "stamp.sec"))
    pub.wait_for(r"stamp=builtin_interfaces.msg.Time\(sec=0, nanosec=0\)")  # no /clock message yet
    clock = ("topic", "pub", "-r", "50", "--print", "0", "/clock", "rosgraph_msgs/msg/Clock")
    start(forked_manycore(*clock, "{clock: {sec: 5}}")).wait_for("beginning")
    echo.wait_for("^5$")
    assert echo.stop() == 0
    assert pub.stop() == 0


def test_values_from_standard_input_and_files(start, manycore, tmp_path) -> None:
    heard = start(forked_manycore("topic", "echo", "/talk", "std_msgs/msg/String"))
    pub = ("topic", "pub", "--once", "--stdin", "/talk", "std_msgs/msg/String")
    # Without the middleware in its environment it restarts itself, and must not lose its input.
    alone = start(manycore_command(*pub), RMW_IMPLEMENTATION="")
    alone.say("data: from standard input")
    alone.close_input()
    assert alone.wait() == 0, alone
    heard.wait_for("^data: from standard input$")
    echoed = tmp_path / "echoed.yaml"
    echoed.write_text("data: one\n---\ndata: two\n---\n")
    file = ("topic", "pub", "-r", "50", "-w", "1", "--yaml-file", str(echoed))
    assert "publishing #2: std_msgs.msg.String(data='two')" in manycore(*file, *pub[-2:])
    heard.wait_for("^data: one$")
    heard.wait_for("^data: two$")
    assert heard.stop() == 0
    for words in (
        (*pub, "data: x"),
        (*file, *pub[-2:], "data: x"),
        (*pub[:3], "-t", "2", *pub[-2:]),
    ):
        assert "are mutually exclusive" in manycore(*words, status=2, text="")
    assert "--max-wait-time-secs requires" in manycore(
        *("topic", "pub", "--max-wait-time-secs", "1", *pub[-2:]), status=2
    )
    unknown = manycore(*pub[:3], "/talk", "std_msgs/msg/Stringg", status=1)
    assert "The passed message type is invalid: 'std_msgs/msg/Stringg'" in unknown
    assert "did you mean 'std_msgs/msg/String'?" in unknown


def test_calls_of_a_service_are_shown(running, start, manycore) -> None:
    echo = start(forked_manycore("service", "echo", "/switch", "--flow-style"))
    csv = start(forked_manycore("service", "echo", "/switch", "std_srvs/srv/SetBool", "--csv"))
    lines = start(forked_manycore("service", "echo", "/switch", "--json"))
    called = start(forked_manycore("service", "call", "-r", "20", "--stdin", *SWITCH))
    called.say("data: true")
    called.close_input()
    echo.wait_for("^  event_type: REQUEST_RECEIVED$")
    echo.wait_for(r"^  client_gid: \[\d+, .*\]$")
    echo.wait_for(r"^request: \[\{data: true\}\]$|^request:$")
    echo.wait_for("^---$")
    echo.wait_for("^  event_type: RESPONSE_SENT$")
    csv.wait_for(r"^1,\d+,\d+,(\d+,){16}\d+,True$")
    csv.wait_for(r"^2,\d+,\d+,(\d+,){16}\d+,True,on$")
    event = json.loads(lines.wait_for("RESPONSE_SENT").string)
    assert event["response"] == [{"success": True, "message": "on"}]
    assert called.stop() == 0
    assert [program.stop() for program in (echo, csv, lines)] == [0, 0, 0]
    silent = start(forked_manycore("service", "echo", "/filter/get_parameters"))
    silent.wait_for("No publishers on topic '/filter/get_parameters/_service_event'; is service")
    silent.stop()
    unknown = manycore("service", "info", "/switchh", status=1)
    assert unknown == "manycore: Unknown service '/switchh'; did you mean '/switch'?"


SWITCH = ("/switch", "std_srvs/srv/SetBool")


def test_parameters_with_the_options_of_ros2(running, manycore) -> None:
    node = ("/filter", "--include-hidden-nodes", "--timeout", "1", "--no-daemon")
    assert manycore("param", "get", *node, "gain") == "Double value is: 2.5"
    assert manycore("param", "set", *node, "gain", "-1.5") == "Set parameter successful"
    assert manycore("param", "get", *node, "gain", "--hide-type") == "-1.5"
    prefixes = ("param", "list", "/filter", "--param-prefixes", "limits", "no")
    assert manycore(*prefixes, "--param-type") == "  limits.low (type: integer)"
    assert "requires an argument" in manycore("param", "list", "--param-prefixes", status=2)
    missing = manycore("param", "get", "/filter", "gian", status=1)
    assert missing == "manycore: Parameter not set: /filter has no gian; did you mean 'gain'?"
    missing = manycore("param", "get", "filtr", "gain", "--timeout", "0", status=1)
    assert missing == "manycore: Node not found: '/filtr'; did you mean '/filter'?"


def test_parameters_are_loaded_with_and_without_wildcards(running, manycore, tmp_path) -> None:
    file = tmp_path / "filter.yaml"
    file.write_text(
        "/**: {ros__parameters: {gain: 1.0}}\n/filter: {ros__parameters: {name: right}}\n"
    )
    load = ("param", "load", "/filter", str(file))
    assert manycore(*load, "--no-use-wildcard") == "Set parameter name successful"
    assert manycore("param", "get", "/filter", "gain") == "Double value is: 2.5"
    assert manycore(*load).splitlines()[0] == "Set parameter gain successful"
    file.write_text("/**/filter: {ros__parameters: {gain: 1.0, gain: -.5, left_out: []}}\n")
    assert manycore(*load) == "Set parameter gain successful"
    assert manycore("param", "get", "/filter", "gain") == "Double value is: -0.5"
    assert "no parameters for /filter: there are some for /**/filter" in manycore(
        *load, "--no-use-wildcard", status=2
    )
    file.write_text("/filter:\n  ros__parameters: {gain: [1, a]}\n")
    assert f"{file}:2: expected a parameter file that rcl reads" in manycore(*load, status=2)


def test_a_parameter_of_a_node_that_is_starting(start) -> None:
    get = start(forked_manycore("param", "get", "/filter", "name", "--timeout", "-1"))
    start(peer_command(a_bit_of_everything))
    assert get.wait() == 0, get
    assert get.output == "String value is: left"


def two_of_a_name() -> None:
    import rclpy
    from rclpy.lifecycle import LifecycleNode

    with peer_node("twin") as node:
        others = rclpy.create_node("twin"), LifecycleNode("_managed")
        for other in others:
            rclpy.get_global_executor().add_node(other)
        announce("ready")
        rclpy.spin(node)


def test_nodes_with_the_options_of_ros2(start, manycore) -> None:
    start(peer_command(two_of_a_name)).wait_for("ready")
    lines = manycore("node", "list", "--no-daemon").splitlines()
    assert sorted(lines)[:2] == ["/twin", "/twin"]
    assert "WARNING: Be aware that there are nodes in the graph that share an exact" in lines[0]
    assert manycore("node", "list", "-a", "-c") == "3"
    assert "Unable to find node '/twn'; did you mean '/twin'?" in manycore(
        "node", "info", "/twn", status=1
    )


def test_lifecycles_with_the_options_of_ros2(start, manycore) -> None:
    start(peer_command(two_of_a_name)).wait_for("ready")
    assert manycore("lifecycle", "nodes") == ""
    assert manycore("lifecycle", "nodes", "-a") == "/_managed"
    assert manycore("lifecycle", "get") == ""
    hidden = ("--include-hidden-nodes", "--no-daemon")
    assert manycore("lifecycle", "get", *hidden) == "/_managed: unconfigured [1]"
    assert manycore("lifecycle", "set", "_managed", "configure", *hidden).endswith("successful")


def test_a_goal_from_standard_input(start, manycore) -> None:
    start(forked_example("fibonacci_server"))
    goal = ("action", "send_goal", "--stdin", "/fibonacci", "test_msgs/action/Fibonacci")
    assert "     order: 2\n" in manycore(*goal, text="order: 2")
    assert "are mutually exclusive" in manycore(*goal, "{order: 1}", status=2, text="")


def test_types_and_packages(manycore) -> None:
    show = ("interface", "show", "--no-comments", "-")
    assert manycore(*show, text="std_msgs/msg/Bool") == "bool data"
    assert "are mutually exclusive" in manycore(
        "interface", "show", "--no-comments", "--all-comments", "a/msg/B", status=2
    )
    assert "Unknown package 'std_mgs'; did you mean 'std_msgs'?" in manycore(
        "interface", "package", "std_mgs", status=1
    )
    unknown = manycore("interface", "show", "std_srvs/srv/SetBol", status=1)
    assert unknown.endswith(
        "Could not find the interface 'std_srvs/srv/SetBol'; did you mean 'std_srvs/srv/SetBool'?"
    )


def test_the_doctor_takes_what_ros2_doctor_takes(manycore, tmp_path, monkeypatch) -> None:
    monkeypatch.setenv("MANYCORE_DIRECTORY", str(tmp_path))  # other tests leave dead platforms
    report = manycore("doctor", "--report", "--exclude-packages")
    assert "\nversions:\n" in report
    assert "ROS 2 wheels" not in report
    assert manycore("doctor", "--report-failed") == ""
    shown = json.loads(manycore("doctor", "--json"))
    warned = any(finding["verdict"] == "warning" for finding in shown)
    strict = manycore("doctor", "-iw", "-rf", "--json", status=int(warned))
    assert {finding["verdict"] for finding in json.loads(strict)} <= {"warning"}
