# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The verbs that inspect a running platform and the installation."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from typing import Any

import pytest

from support import IS_MANYCORE, MAPFILES, wait_until
from support.peers.programs import forked_example, forked_manycore
from support.processes.commands import manycore_command
from support.processes.inspection import kill_all
from support.processes.platforms import PLATFORMS, environment, leftovers

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="manycore is about rmw_manycore"),
]


@pytest.fixture
def running(start, platform):
    run = start(forked_manycore("run", MAPFILES / "talker_listener.yaml", "--json"))
    run.wait_for("I heard")
    yield run
    assert run.stop() == 0


def test_topics_and_nodes_are_listed(running, manycore) -> None:
    assert "/chatter [std_msgs/msg/String]" in manycore("topic", "list", "-t").splitlines()
    assert manycore("node", "list").splitlines() == ["/listener", "/talker"]
    rows = {row["node"]: row for row in json.loads(manycore("node", "list", "--json"))}
    assert (rows["/talker"]["cluster"], rows["/talker"]["core"]) == (1, 1)
    assert (rows["/listener"]["cluster"], rows["/listener"]["core"]) == (2, 1)


def test_a_topic_is_described(running, manycore) -> None:
    assert manycore("topic", "info", "/chatter").splitlines() == [
        "Type: std_msgs/msg/String",
        "Publisher count: 1",
        "Subscription count: 1",
    ]
    lines = manycore("topic", "info", "-v", "/chatter").splitlines()
    assert lines[2:6] == ["Publisher count: 1", "", "Node name: talker", "Node namespace: /"]
    assert "  History (Depth): KEEP_LAST (10)" in lines
    assert "Unknown topic" in manycore("topic", "info", "/nothing", status=1)


def test_a_node_is_described(running, manycore) -> None:
    lines = manycore("node", "info", "/listener").splitlines()
    assert lines[:3] == ["/listener", "  Subscribers:", "    /chatter: std_msgs/msg/String"]
    server = "    /listener/list_parameters: rcl_interfaces/srv/ListParameters"
    assert server in lines[lines.index("  Service Servers:") :]
    assert "Unable to find node" in manycore("node", "info", "/nobody", status=1)


def test_messages_are_printed_as_ros2_does(running, start, manycore) -> None:
    echo = start(manycore_command("topic", "echo", "/chatter"), RMW_IMPLEMENTATION="")
    echo.wait_for(r"^data: 'Hello World: \d+'$")
    echo.wait_for(r"^---$")
    assert echo.stop() == 0
    assert (
        "Hello World"
        in json.loads(manycore("topic", "echo", "--once", "--json", "/chatter"))["data"]
    )
    assert "give its type" in manycore("topic", "echo", "/nothing", status=1)


def test_echo_takes_what_ros2_topic_echo_takes(running, manycore) -> None:
    def echo(*words: str) -> str:
        return manycore("topic", "echo", "--once", "chatter", *words)

    assert echo("-l", "5").splitlines() == ["data: Hello...", "---"]
    assert re.fullmatch(r"<string length: <\d+>>", echo("--csv", "--no-str"))
    assert re.fullmatch(r"Hello World: \d+", echo("--csv"))
    assert "Hello" in echo("--flow-style", "--qos-reliability", "best_effort")
    assert "b'" in echo("--raw")
    assert "Hello" in echo("--filter", "'World' in m.data")
    with_info = echo("--include-message-info").splitlines()
    assert [line.split(":")[0] for line in with_info] == [
        "publication_sequence_number",
        "received_timestamp",
        "reception_sequence_number",
        "source_timestamp",
        "---",
        "data",
        "---",
    ]
    assert re.fullmatch(r"(\d+,){4}Hello World: \d+", echo("-i", "--csv"))
    words = ("topic", "echo", "/chatter", "--filter", "'?' in m.data", "--timeout", "0.5")
    assert manycore(*words) == ""


def test_lists_take_what_those_of_ros2_take(running, manycore) -> None:
    shown = manycore("topic", "list", "-v")
    assert " * /chatter [std_msgs/msg/String] 1 publisher\n" in shown
    assert " * /chatter [std_msgs/msg/String] 1 subscriber\n" in shown
    for words in (("node", "list", "-c"), ("node", "list", "--count-nodes")):
        assert manycore(*words) == "2"
    for words in (("topic", "find", "-c"), ("topic", "find", "--count-topics")):
        assert manycore(*words, "std_msgs/msg/String") == "1"
    count = ("service", "find", "--count-services", "rcl_interfaces/srv/GetParameters")
    assert manycore(*count) == "2"
    hidden = ["/_manycore_bridge_inward", "/_manycore_bridge_outward"]
    nodes = [*hidden, "/listener", "/talker"]
    wait_until(lambda: manycore("node", "list", "--all").splitlines() == nodes, "all are there")


def test_echo_waits_for_a_topic_whose_type_is_given(start, platform) -> None:
    echo = start(manycore_command("topic", "echo", "--once", "/chatter", "std_msgs/msg/String"))
    wait_until(lambda: leftovers(platform), "echo has made the platform")
    talker = start(forked_example("talker"))
    assert echo.wait() == 0
    assert "data: 'Hello World" in echo.output
    assert talker.stop_node()


def test_the_rate_is_printed_as_ros2_does(running, start) -> None:
    hz = start(forked_manycore("topic", "hz", "/chatter"))
    hz.wait_for(r"^average rate: \d+\.\d{3}$")
    hz.wait_for(r"^\tmin: \d+\.\d{3}s max: \d+\.\d{3}s std dev: \d+\.\d{5}s window: \d+$")
    assert hz.stop() == 0


def test_status_shows_the_places_of_processes(running, manycore, platform) -> None:
    def row() -> dict[str, Any]:
        return json.loads(manycore("status", "--platform", platform, "--json"))[0]

    def is_served() -> bool:
        return [cluster["alive"] for cluster in row()["clusters"]] == [True, True]

    wait_until(is_served, "both clusters have a receive thread")
    state = row()
    assert state["alive"]
    nodes = {node for process in state["processes"] for node in process["nodes"]}
    assert {"/talker", "/listener"} <= nodes
    assert f"platform {platform}: alive" in manycore("status", "--platform", platform)


def test_a_living_platform_is_not_cleaned(running, manycore, platform) -> None:
    assert "is alive" in manycore("clean", platform, status=1)
    assert leftovers(platform)
    assert f"no platform '{platform}x'" in manycore("clean", f"{platform}x", status=1)


def test_a_dead_platform_is_seen_and_cleaned(start, manycore, platform) -> None:
    directory = PLATFORMS / platform
    start(forked_example("talker")).wait_for("Publishing")
    kill_all(platform)
    (directory / "registry").write_bytes(bytes(4096))
    assert f"platform {platform}: " in manycore("status")
    assert platform in manycore("doctor")
    assert str(directory) in manycore("clean", platform)
    assert leftovers(platform) == []


def test_the_doctor_finds_this_installation_well(manycore) -> None:
    findings = {row["subject"]: row for row in json.loads(manycore("doctor", "--json"))}
    assert findings["substitution"]["found"] == "rclpy uses rmw_manycore"
    assert all(row["verdict"] != "failure" for row in findings.values())
    assert "ok       substitution: rclpy uses rmw_manycore" in manycore("doctor")


def test_a_shell_with_the_exports_uses_rmw_manycore(platform) -> None:
    manycore = " ".join(map(str, manycore_command("env")))
    probe = "import rclpy; print(rclpy.get_rmw_implementation_identifier())"
    shell = f'eval "$({manycore})" && {sys.executable} -c "{probe}"'
    plain = {k: v for k, v in environment(platform).items() if k != "RMW_IMPLEMENTATION"}
    result = subprocess.run(
        ["sh", "-c", shell], env=plain, text=True, capture_output=True, check=True
    )
    assert result.stdout.split() == ["rmw_manycore"]


def test_ctrl_c_ends_a_bridge_well_that_still_reads_its_file(start, tmp_path) -> None:
    config = tmp_path / "bridge.yaml"
    os.mkfifo(config)  # a read of it blocks until the test writes
    program = start(manycore_command("bridge", "run", config))
    with config.open("w"):  # returns once the program has opened it
        assert program.stop() == 0, program
    assert program.output == ""
