# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The verbs of `ros2` under `manycore`, on real nodes."""

from __future__ import annotations

import json
import signal
import sys
from collections.abc import Iterator
from typing import Any

import pytest
import yaml

from rmw_manycore_py.ros.parameter_files import read_file
from support import IS_MANYCORE
from support.nodes.ros import announce, peer_node
from support.peers.programs import forked_example, forked_manycore
from support.processes.commands import peer_command
from support.processes.program import Program

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="manycore is about rmw_manycore"),
]

SLOW = ("--ros-args", "-p", "rate_hz:=0.001")


def test_services_are_listed_and_called(start, manycore) -> None:
    start(forked_example("lamp"), 2).skip_output()
    called = manycore("service", "call", "/switch_lamp", "std_srvs/srv/SetBool", "{data: true}")
    assert called.splitlines()[-4:] == [
        "requester: making request: std_srvs.srv.SetBool_Request(data=True)",
        "",
        "response:",
        "std_srvs.srv.SetBool_Response(success=True, message='the lamp is on')",
    ]
    call = ("service", "call", "--json", "/switch_lamp", "std_srvs/srv/SetBool")
    assert json.loads(manycore(*call)) == {"success": True, "message": "the lamp is off"}
    listed = manycore("service", "list", "-t").splitlines()
    assert "/switch_lamp [std_srvs/srv/SetBool]" in listed
    assert "/lamp/list_parameters [rcl_interfaces/srv/ListParameters]" in listed
    assert manycore("service", "type", "/switch_lamp") == "std_srvs/srv/SetBool"
    assert manycore("service", "find", "std_srvs/srv/SetBool") == "/switch_lamp"
    assert manycore("service", "info", "/switch_lamp").splitlines() == [
        "Type: std_srvs/srv/SetBool",
        "Clients count: 0",
        "Services count: 1",
    ]
    assert "Unknown service '/none'" in manycore("service", "type", "/none", status=1)
    assert "no field 'state'" in manycore(*call, "{state: true}", status=2)


def with_parameters() -> None:
    from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor

    with peer_node("filter") as node:
        bounds = FloatingPointRange(from_value=0.0, to_value=10.0, step=0.5)
        about = ParameterDescriptor(description="loop gain", floating_point_range=[bounds])
        node.declare_parameter("gain", 2.5, about)
        node.declare_parameter("limits.low", [1, 2])
        node.declare_parameter("name", "left")
        _serve(node)


def _serve(node) -> None:
    import rclpy

    announce("ready")
    rclpy.spin(node)


@pytest.fixture
def parameters(start):
    start(peer_command(with_parameters)).wait_for("ready")


@pytest.mark.usefixtures("parameters")
def test_parameters_are_listed_and_read(manycore) -> None:
    listed = manycore("param", "list").splitlines()
    assert listed[:4] == ["/filter:", "  gain", "  limits.low", "  name"]
    assert "  gain (type: double)" in manycore("param", "list", "filter", "--param-type")
    assert manycore("param", "list", "/filter", "--filter", "na|lim") == "  limits.low\n  name"
    assert "--filter: " in manycore("param", "list", "--filter", "[", status=2)
    assert manycore("param", "get", "/filter", "gain") == "Double value is: 2.5"
    assert manycore("param", "get", "/filter", "limits.low") == "Integer values are: [1, 2]"
    assert manycore("param", "describe", "/filter", "gain").splitlines() == [
        "Parameter name: gain",
        "  Type: double",
        "  Description: loop gain",
        "  Constraints:",
        "    Min value: 0.0",
        "    Max value: 10.0",
        "    Step: 0.5",
    ]
    dumped = yaml.safe_load(manycore("param", "dump", "/filter"))["/filter"]["ros__parameters"]
    assert (dumped["gain"], dumped["limits"], dumped["name"]) == (2.5, {"low": [1, 2]}, "left")
    none = ("param", "get", "none", "x", "--timeout", "0")
    assert "Node not found: '/none'" in manycore(*none, status=1)


@pytest.mark.usefixtures("parameters")
def test_parameters_are_set(manycore) -> None:
    assert manycore("param", "set", "/filter", "gain", "3.5") == "Set parameter successful"
    assert manycore("param", "get", "/filter", "gain", "--hide-type") == "3.5"
    refused = manycore("param", "set", "/filter", "gain", "99.0", status=1)
    assert "Setting parameter failed: Parameter gain out of range" in refused
    unknown = manycore("param", "set", "/filter", "gian", "3.5", status=1)
    assert "did you mean 'gain'?" in unknown
    assert "cannot be undeclared" in manycore("param", "delete", "/filter", "name", status=1)


@pytest.mark.usefixtures("parameters")
def test_parameters_are_loaded(manycore, tmp_path) -> None:
    file = tmp_path / "filter.yaml"
    file.write_text("/**: {ros__parameters: {gain: 1.5, name: right}}")
    assert manycore("param", "load", "/filter", str(file)).splitlines() == [
        "Set parameter gain successful",
        "Set parameter name successful",
    ]
    assert manycore("param", "get", "/filter", "name") == "String value is: right"
    file.write_text("other: {ros__parameters: {gain: 1.5}}")
    assert "there are some for other" in manycore("param", "load", "/filter", str(file), status=2)


# Without quotes, YAML 1.1 or rcl takes each for something else than a string.
STRINGS = [
    *("y", "n", "Y", "on", "~", "null", "1e5", "1E5", "-.5", "1e-3", "1e+5", ".5e3", "inf", "nan"),
    *("08", "0483", "0x1F", "1_000", "12:30:00", "", " x ", "a: b", "# c", "é", "\u2028", "1\n2\t"),
]


def with_values_of_all_types() -> None:
    from rcl_interfaces.msg import ParameterDescriptor

    with peer_node("typed") as node:
        for number, text in enumerate(STRINGS):
            node.declare_parameter(f"strings.s{number:02}", text)
        node.declare_parameter("several", STRINGS)
        node.declare_parameter("several.more", 1)
        node.declare_parameter("numbers", [1e20, -0.5, float("inf")])
        node.declare_parameter("flags", [True, False])
        node.declare_parameter("data", [b"\x00", b"\xff"])
        node.declare_parameter("none", None, ParameterDescriptor(dynamic_typing=True))
        _serve(node)


def test_dumped_parameters_are_loaded_as_they_were(start, manycore, tmp_path) -> None:
    start(peer_command(with_values_of_all_types)).wait_for("ready")
    dumped = manycore("param", "dump", "/typed")
    notices = [line for line in dumped.splitlines() if line.startswith("notice: ")]
    assert notices == [
        "notice: left out 'data' (byte array): parameter files cannot hold it",
        "notice: left out 'none' (not set): parameter files cannot hold it",
    ]
    file = tmp_path / "typed.yaml"
    file.write_text("\n".join(line for line in dumped.splitlines() if line not in notices))
    ((section, values),) = read_file(file)
    assert section == "/typed"
    assert [values[f"strings.s{number:02}"] for number in range(len(STRINGS))] == STRINGS
    assert (values["several"], values["several.more"]) == (STRINGS, 1)
    assert values["numbers"] == [1e20, -0.5, float("inf")]
    assert values["flags"] == [True, False]
    loaded = manycore("param", "load", "/typed", str(file), status=1).splitlines()
    failed = [line for line in loaded if not line.endswith(" successful")]
    assert (len(loaded), len(failed)) == (len(values), 1)
    assert "start_type_description_service failed: Trying to set a read-only" in failed[0]
    assert manycore("param", "dump", "/typed") == dumped


def test_json_has_no_bytes_and_no_infinity(start, manycore) -> None:
    start(peer_command(with_values_of_all_types)).wait_for("ready")
    get = ("param", "get", "--json", "/typed")
    data = manycore(*get, "data")
    assert strict(data) == {"name": "data", "type": "byte array", "value": [0, 255]}
    assert strict(manycore(*get, "numbers"))["value"] == [1e20, -0.5, "inf"]
    dumped = strict(manycore("param", "dump", "--json", "/typed"))["/typed"]["ros__parameters"]
    assert (dumped["data"], dumped["numbers"][2]) == ([0, 255], "inf")
    level = ("/level", "std_msgs/msg/Float64")
    start(forked_manycore("topic", "pub", "-r", "50", *level, "data: .nan")).wait_for("#1")
    assert strict(manycore("topic", "echo", "--once", "--json", *level)) == {"data": "nan"}


def strict(text: str) -> Any:
    """Read JSON as other languages do, which take no NaN and no Infinity."""

    def refuse(word: str) -> None:
        raise AssertionError(f"{word} is not JSON")

    return json.loads(text, parse_constant=refuse)


def fibonacci_by_steps() -> None:
    """Serve Fibonacci: each line of input is a step, and the last line succeeds."""
    from rclpy.action import ActionServer
    from test_msgs.action import Fibonacci

    with peer_node("fibonacci_server") as node:

        def execute(goal):
            sequence = [0, 1]
            while sys.stdin.readline() and len(sequence) <= goal.request.order:
                sequence.append(sequence[-2] + sequence[-1])
                goal.publish_feedback(Fibonacci.Feedback(sequence=sequence))
            goal.succeed()
            return Fibonacci.Result(sequence=sequence)

        _server = ActionServer(node, Fibonacci, "fibonacci", execute)
        _serve(node)


def test_actions_get_goals(start) -> None:
    server = start(peer_command(fibonacci_by_steps), 2)
    goal = ("/fibonacci", "test_msgs/action/Fibonacci")
    sender = start(forked_manycore("action", "send_goal", "-f", *goal, "{order: 3}"))
    sender.wait_for("^Goal accepted")
    for _ in range(2):  # rclpy drops feedback once the result has arrived
        server.say("step")
        sender.wait_for("^Feedback:$")
    server.say("end")
    assert sender.wait() == 0
    lines = sender.lines
    assert lines[0] == "Waiting for an action server to become available..."
    assert lines[1:4] == ["Sending goal:", "     order: 3", ""]
    assert lines[4].startswith("Goal accepted with ID: ")
    assert lines.count("Feedback:") == 2
    result = lines.index("Result:")
    assert lines[result : result + 6] == ["Result:", "    sequence:", "- 0", "- 1", "- 1", "- 2"]
    assert lines[-1] == "Goal finished with status: SUCCEEDED"


def test_actions_are_listed(start, manycore) -> None:
    start(peer_command(fibonacci_by_steps), 2).wait_for("ready")
    assert manycore("action", "list", "-t") == "/fibonacci [test_msgs/action/Fibonacci]"
    assert manycore("action", "type", "/fibonacci") == "test_msgs/action/Fibonacci"
    assert manycore("action", "info", "/fibonacci", "-t").splitlines() == [
        "Action: /fibonacci",
        "Action clients: 0",
        "Action servers: 1",
        "    /fibonacci_server [test_msgs/action/Fibonacci]",
    ]


def test_an_interrupt_cancels_a_goal(start) -> None:
    start(forked_example("fibonacci_server", *SLOW), 2)
    goal = ("/fibonacci", "test_msgs/action/Fibonacci", "{order: 3}")
    sender = start(forked_manycore("action", "send_goal", *goal))
    sender.wait_for("Goal accepted")
    sender.signal(signal.SIGINT)
    sender.wait_for("Goal canceled.")
    assert sender.wait() == 0


def with_lifecycle() -> None:
    import rclpy
    from rclpy.lifecycle import LifecycleNode

    rclpy.init()
    node = LifecycleNode("camera")
    _serve(node)


def test_lifecycles_are_seen_and_changed(start, manycore) -> None:
    start(peer_command(with_lifecycle)).wait_for("ready")
    assert manycore("lifecycle", "nodes") == "/camera"
    assert manycore("lifecycle", "get") == "/camera: unconfigured [1]"
    lines = manycore("lifecycle", "list", "/camera").splitlines()
    assert lines[:3] == ["- configure [1]", "\tStart: unconfigured", "\tGoal: configuring"]
    unknown = manycore("lifecycle", "set", "/camera", "fly", status=2)
    assert "- configure [1]\n- shutdown [5]" in unknown
    assert manycore("lifecycle", "set", "/camera", "configure") == "Transitioning successful"
    assert manycore("lifecycle", "set", "/camera", "3") == "Transitioning successful"
    assert manycore("lifecycle", "get", "camera") == "active [3]"
    assert "Node not found: no '/none' with a lifecycle" in manycore(
        "lifecycle", "get", "none", status=1
    )


def test_messages_are_published_as_ros2_does(start, manycore) -> None:
    echo = start(forked_manycore("topic", "echo", "/chatter", "std_msgs/msg/String"))
    pub = ("topic", "pub", "-t", "2", "-r", "50", "/chatter", "std_msgs/msg/String")
    lines = manycore(*pub, "data: hello").splitlines()
    assert lines[-4:] == [
        "publisher: beginning loop",
        "publishing #1: std_msgs.msg.String(data='hello')",
        "",
        "publishing #2: std_msgs.msg.String(data='hello')",
    ]
    for _ in range(2):
        echo.wait_for("^data: hello$")
    assert echo.stop() == 0
    nobody = manycore(*pub[:2], "-1", "--max-wait-time-secs", "0.2", *pub[-2:], status=1)
    assert nobody.splitlines() == [
        "Waiting for at least 1 matching subscription(s)...",
        "manycore: Timed out waiting for subscribers: "
        "Expected 1 subscribers but only got 0 subscribers",
    ]


def publish_bursts() -> None:
    import rclpy
    from std_msgs.msg import String

    with peer_node() as node:
        publisher = node.create_publisher(String, "/bursts", 100)

        def burst() -> None:
            for number in range(100):
                publisher.publish(String(data=str(number)))

        node.create_timer(0.1, burst)
        announce("ready")
        rclpy.spin(node)


def test_echo_reports_lost_messages(start) -> None:
    start(peer_command(publish_bursts)).wait_for("ready")
    echo = ("topic", "echo", "/bursts", "--qos-depth", "2")
    told = start(forked_manycore(*echo))
    told.wait_for("^A message was lost!!!$")
    told.wait_for(r"^\ttotal count change:\d+$")
    told.wait_for(r"^\ttotal count: \d+---$")
    assert told.stop() == 0
    silent = start(forked_manycore(*echo, "--no-lost-messages"))
    for _ in range(3):  # of a hundred at once
        silent.wait_for("^data: ")
    assert silent.stop() == 0
    assert "lost" not in silent.output


@pytest.fixture
def posing(start) -> Iterator[Program]:
    """Publish poses with stamps; afterwards check that Ctrl-C ends it well."""
    pose = ("/pose", "geometry_msgs/msg/PoseStamped")
    pub = start(forked_manycore("topic", "pub", "-r", "50", *pose, "{header: auto}"))
    pub.wait_for("publishing #1")
    yield pub
    assert pub.stop() == 0


@pytest.mark.usefixtures("posing")
def test_bandwidth_and_delay_of_a_topic(start, manycore) -> None:
    watchers = [start(forked_manycore("topic", verb, "/pose")) for verb in ("bw", "delay")]
    watchers[0].wait_for(r"^(\d+\.\d\d K|\d+ )B/s from \d+ messages$")
    watchers[0].wait_for(r"^\tMessage size mean: 0\.08 KB min: 0\.08 KB max: 0\.08 KB$")
    watchers[1].wait_for(r"^average delay: \d+\.\d{3}$")
    watchers[1].wait_for(r"^\tmin: \d+\.\d{3}s max: \d+\.\d{3}s std dev: \d+\.\d{5}s window: \d+$")
    assert [watcher.stop() for watcher in watchers] == [0, 0]
    assert manycore("topic", "type", "/pose") == "geometry_msgs/msg/PoseStamped"
    assert manycore("topic", "find", "geometry_msgs/msg/PoseStamped") == "/pose"


def test_load_of_topics_and_processes(start, manycore, posing) -> None:
    top = start(forked_manycore("top", "--json"))
    moved = r'^\{.*"topic": "/pose", "messages_per_s": (?!0\.0,).*'
    load = json.loads(top.wait_for(moved).group())
    assert top.stop() == 0
    assert load["topics"][0]["topic"] == "/pose"
    assert posing.pid in {process["pid"] for process in load["processes"]}
    assert "messages/s" in manycore("top", "--count", "1", "--period", "0.1")
