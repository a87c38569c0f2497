# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Names in a damaged registry are shown as far as they are readable; the tools go on."""

from __future__ import annotations

import json

import pytest
from std_msgs.msg import String

from support import IS_MANYCORE
from support.nodes.ros import announce, peer_node, spin
from support.peers.programs import forked_example, forked_manycore
from support.processes.commands import example_command, peer_command
from support.processes.platforms import PLATFORMS
from support.processes.program import Program

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="damages the files of rmw_manycore"),
]

NAME_BYTES = 256  # a field in the registry: the name, padded with zeros


@pytest.fixture
def talker(start) -> Program:
    program = start(example_command("talker", "--ros-args", "-p", "rate_hz:=20.0"))
    program.wait_for("Publishing")
    return program


@pytest.fixture
def rows(start, platform):
    """Return a function that runs a verb and returns the items it lists."""

    def call(*words: str) -> list[dict]:
        program = start(forked_manycore(*words, "--platform", platform, "--json"))
        assert program.wait() == 0, program
        return json.loads(program.output)

    return call


def overwrite_name(platform: str, name: bytes, damaged: bytes) -> None:
    """Overwrite each field that contains this name."""
    with (PLATFORMS / platform / "registry").open("r+b") as file:
        content = file.read()
        field = name.ljust(NAME_BYTES, b"\0")
        place = content.find(field)
        assert place >= 0
        while place >= 0:
            file.seek(place)
            file.write(damaged.ljust(NAME_BYTES, b"\0"))
            place = content.find(field, place + NAME_BYTES)


def test_a_topic_that_is_no_utf_8(talker, rows, platform):
    overwrite_name(platform, b"/chatter", b"/ch\xff\xc3tter")
    names = [row["name"] for row in rows("topic", "list")]
    assert names == ["/ch\ufffd\ufffdtter", "/parameter_events", "/rosout"]


def test_a_topic_that_does_not_end(talker, rows, platform):
    overwrite_name(platform, b"/chatter", b"\xff" * NAME_BYTES)
    listed = {row["name"]: row["types"] for row in rows("topic", "list", "-t")}
    assert listed["\ufffd" * NAME_BYTES] == ["std_msgs/msg/String"]
    assert listed["/rosout"] == ["rcl_interfaces/msg/Log"]


def test_a_node_that_is_no_utf_8(talker, rows, start, platform):
    start(forked_example("listener")).wait_for("I heard")
    overwrite_name(platform, b"talker", b"\xfe\xfftalker")
    (state,) = rows("status")
    nodes = [node for process in state["processes"] for node in process["nodes"]]
    assert sorted(nodes) == ["/listener", "/\ufffd\ufffdtalker"]
    assert {row["node"] for row in rows("node", "list")} == {"/listener", "/\ufffd\ufffdtalker"}
    for words in (("status",), ("topic", "info", "-v", "/chatter"), ("node", "list")):
        program = start(forked_manycore(*words, "--platform", platform))
        assert program.wait() == 0, program
        assert "\ufffd\ufffdtalker" in program.output, program


CONTROLS = "\x1b]0;evil\x07\n[/b]\u0085\u202e"
SHOWN = r"\x1b]0;evil\x07\n[/b]\x85\u202e"
YAML = r"\e]0;evil\a\n[/b]\N\u202e"


def test_names_reach_no_terminal_as_control_characters(talker, rows, start, platform):
    start(forked_example("listener")).wait_for("I heard")
    overwrite_name(platform, b"talker", CONTROLS.encode())
    overwrite_name(platform, b"/chatter", f"/{CONTROLS}".encode())
    overwrite_name(platform, b"std_msgs/msg/String", f"std_msgs/{CONTROLS}".encode())
    label = next(row["label"] for row in rows("status")[0]["processes"] if "talker" in row["label"])
    overwrite_text(platform, label.encode(), CONTROLS.encode()[: len(label)])
    verbs = ("status", "node list", "topic list -v", "topic list -t", "top --count 1", "doctor")
    named = ("topic info -v", "topic info", "topic type", "node info")
    for verb in (*verbs, *named):
        words = (*verb.split(), f"/{CONTROLS}") if verb in named else verb.split()
        option = () if verb == "doctor" else ("--platform", platform)
        program = start(forked_manycore(*words, *option))
        program.wait()
        assert program.output, verb
        assert not any(line.startswith("[/b]") for line in program.output.split("\n")), program
        strange = {c for c in program.output if not c.isprintable()} - {"\n"}
        assert (strange, "Traceback" in program.output) == (set(), False), program
        if verb != "doctor":
            assert SHOWN in program.output, program
    names = [row["name"] for row in rows("topic", "list")]
    assert f"/{CONTROLS}" in names


def speak_controls() -> None:
    """Publish a text of control characters, and have a parameter of that value."""
    with peer_node("speaker") as node:
        node.declare_parameter("text", CONTROLS)
        publisher = node.create_publisher(String, "/text", 1)
        node.create_timer(0.05, lambda: publisher.publish(String(data=CONTROLS)))
        announce("speaking")
        spin(node)


def test_values_reach_no_terminal_as_control_characters(start, platform):
    """A value that is shown by itself keeps its lines; a row of CSV stays one line."""
    start(peer_command(speak_controls)).wait_for("speaking")
    lines = SHOWN.split(r"\n")
    for verb, shown in (
        ("topic echo --once /text --field data", [*lines, "---"]),
        ("topic echo --once /text --csv", [SHOWN]),
        ("topic echo --once /text", [f'data: "{YAML}"', "---"]),
        ("param get /speaker text --hide-type", lines),
        ("param get /speaker text", [f"String value is: {lines[0]}", lines[1]]),
    ):
        program = start(forked_manycore(*verb.split()))
        assert program.wait() == 0, program
        assert program.lines == shown, program
    asked = start(forked_manycore("topic", "echo", "--once", "/text", "--json"))
    assert asked.wait() == 0, asked
    assert json.loads(asked.output) == {"data": CONTROLS}


def overwrite_text(platform: str, text: bytes, damaged: bytes) -> None:
    """Overwrite a text of the registry by one that is not longer."""
    with (PLATFORMS / platform / "registry").open("r+b") as file:
        place = file.read().find(text + b"\0")
        assert place >= 0
        file.seek(place)
        file.write(damaged.ljust(len(text), b"\0"))
