# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore attach`: connects a user's terminal, here a pseudo-terminal, to that of a node."""

from __future__ import annotations

import signal
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from rmw_manycore_py.native import _transport
from support import IS_MANYCORE, wait_until
from support.peers.programs import forked_manycore
from support.processes.commands import manycore_command
from support.processes.person import Person
from support.processes.platforms import environment

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="manycore attach is about rmw_manycore"),
]

# Like teleop_twist_keyboard: reads single keys in raw mode and publishes them; q ends it.
TELEOP = """
import os, sys, termios, tty
import rclpy
from rclpy.node import Node
from std_msgs.msg import String
before = termios.tcgetattr(sys.stdin)
rclpy.init()
node = Node("teleop")
publisher = node.create_publisher(String, "keys", 10)
try:
    tty.setraw(sys.stdin.fileno())  # discards what was typed before
    print("use the keys\\r", flush=True)
    while (key := sys.stdin.read(1)) != "q":
        publisher.publish(String(data=key))
        print(f"key {key!r}\\r", flush=True)
finally:
    termios.tcsetattr(sys.stdin, termios.TCSADRAIN, before)
"""
# Each line is written whole: a signal handler prints between the words of a print().
SHELL = """
import os, signal, sys, threading
def resized(*_):
    size = os.get_terminal_size()
    print(f"size {size.lines} {size.columns}", flush=True)
signal.signal(signal.SIGWINCH, resized)
try:
    print(f"ready {os.isatty(0)} {os.isatty(1)}", flush=True)
    for line in sys.stdin:
        print("said", line.strip(), flush=True)
except KeyboardInterrupt:
    print("interrupted", flush=True)
    sys.exit(4)
"""


@pytest.fixture
def attach(platform: str) -> Iterator[Callable[..., Person]]:
    people: list[Person] = []

    def attached(*words: str) -> Person:
        people.append(Person(manycore_command("attach", *words), environment(platform)))
        return people[-1]

    yield attached
    for person in people:
        person.close()


@pytest.fixture
def run(start, tmp_path: Path, platform: str):
    """Start a run of a node with that program; stop it at the end."""
    runs = []

    def begin(code: str, keys: str = "terminal: true"):
        (tmp_path / "node.py").write_text(code)
        mapfile = tmp_path / "map.yaml"
        command = f"command: [{sys.executable}, node.py], ros_arguments: false"
        listener = "{cluster: 1, core: 4, command: [sleep, '1000'], ros_arguments: false}"
        mapfile.write_text(
            f"nodes:\n  node: {{cluster: 1, core: 1, {command}, {keys}}}\n  other: {listener}\n"
        )
        runs.append(start(forked_manycore("run", mapfile)))
        return runs[-1]

    yield begin
    for one in runs:
        one.stop()


def is_heard(platform: str) -> bool:
    with _transport.Platform(platform) as opened:
        return any(e.topic == "/keys" and e.matched for e in opened.endpoints())


def test_keys_reach_a_node_that_teleoperates(run, attach, start, platform) -> None:
    running = run(TELEOP)
    running.wait_for("use the keys")
    echo = start(forked_manycore("topic", "echo", "/keys", "std_msgs/msg/String"))
    wait_until(lambda: is_heard(platform), "the echo has found the node")
    person = attach("node")
    person.sees("use the keys")  # its earlier output
    person.type("i")
    person.sees("key 'i'")
    echo.wait_for("^data: i$")
    running.wait_for("^node .*key 'i'")
    running.skip_output()
    person.type("\x03")  # raw mode: a key like any other
    person.sees(r"key '\\x03'")
    person.type("k")
    person.sees("key 'k'")
    person.type("\x10\x11")
    person.sees("node: left running")
    assert person.leaves() == 0
    again = attach("/node")
    again.sees("key 'k'")
    again.type("kkkq")
    again.sees("node: has ended: finished")
    assert again.leaves() == 0
    running.wait_for("^manycore | node finished")
    echo.stop()


def test_sizes_and_signals_are_those_of_a_terminal(run, attach) -> None:
    run(SHELL).wait_for("ready True True")
    person = attach("node", "--detach-keys", "ctrl-x")
    person.sees("size 30 90")
    person.resize(41, 123)
    person.process.send_signal(signal.SIGWINCH)
    person.sees("size 41 123")
    person.type("hello\n")
    person.sees("said hello")
    person.type("\x18")
    person.sees("node: left running")
    assert person.leaves() == 0
    killed = attach("node")
    killed.sees("said hello")
    killed.process.kill()
    third = attach("node")
    third.type("still there\n")
    third.sees("said still there")
    third.type("\x03")
    third.sees("interrupted")
    third.sees("node: has ended: exit status 4")
    assert third.leaves() == 0
    dead = attach("node")
    dead.sees(r"'node' is not running \(exit status 4\): `manycore restart node` starts it")
    assert dead.leaves() == 1


def test_a_respawned_node_stays_attached(run, attach) -> None:
    run(SHELL, "terminal: true, respawn: {delay: 0.1}").wait_for("ready True True")
    person = attach("node")
    person.sees("ready True True")
    person.type("\x03")
    person.sees(r"\[exit status 4; it is started again\]")
    person.sees("ready True True")
    person.type("once more\n")
    person.sees("said once more")
    person.process.terminate()
    person.sees(r"node: left running \(SIGTERM\)")
    assert person.leaves() == 0


def test_a_node_without_a_terminal_can_be_given_one(run, attach) -> None:
    run(SHELL, "wait: block").wait_for("ready False False")
    refused = attach("node")
    refused.sees("'node' has no terminal: set `terminal: true` in the mapfile")
    assert refused.leaves() == 1
    person = attach("--restart", "node")
    person.sees("ready True True")
    person.type("\x10\x11")
    person.sees("left running")
    assert person.leaves() == 0
