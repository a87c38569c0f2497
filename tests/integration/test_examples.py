# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Every example mapfile, run by `manycore run`, with the messages its nodes exchange."""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import pytest
import yaml
from builtin_interfaces.msg import Time

from support import IS_MANYCORE, MAPFILES, TIMEOUT_S, wait_until
from support.nodes.ros import announce, peer_node, spin_until
from support.peers.programs import forked_manycore
from support.processes.commands import peer_command
from support.processes.program import Program

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="manycore run is about rmw_manycore"),
]


NAMED = r'"(\w+\.(?:yaml|map))"'


class Run:
    """The output of `manycore run --json`, grouped by node."""

    def __init__(self, program: Program) -> None:
        self.program = program

    def wait_for(self, node: str, pattern: str) -> re.Match[str]:
        """Return the match in the next matching line of a node's output."""
        output = rf'"event": "output", "node": "{node}", "line": (".*{pattern}.*")'
        line = self.program.wait_for(output, timeout_s=2 * TIMEOUT_S)
        match = re.search(pattern, json.loads(line.group(1)))
        assert match is not None
        return match

    def events(self, kind: str) -> Iterator[dict[str, Any]]:
        """Yield the events of one kind received so far."""
        events = (json.loads(line) for line in self.program.lines if line.startswith("{"))
        return (event for event in events if event["event"] == kind)

    def wait_until_said(self, node: str, *texts: str) -> None:
        """Wait until a node has printed all of these lines, in any order."""

        def said() -> bool:
            lines = [e["line"] for e in self.events("output") if e["node"] == node]
            return all(any(text in line for line in lines) for text in texts)

        wait_until(said, f"{node} says {texts}: {self.program}", 2 * TIMEOUT_S)

    def stop(self) -> None:
        """Stop with Ctrl-C; every node must have worked and ended with status 0."""
        assert "Traceback" not in self.program.output, self.program
        assert self.program.stop() == 0, self.program

    def places(self) -> dict[str, tuple[int, int]]:
        """Return cluster and core of each node started."""
        return {
            event["node"]: (event["cluster"], event["core"]) for event in self.events("started")
        }


@pytest.fixture
def run(start, platform):
    def run(name: str | Path) -> Run:
        return Run(start(forked_manycore("run", MAPFILES / name, "--json")))

    return run


def assert_consecutive(numbers: Iterable[int]) -> None:
    numbers = list(numbers)
    assert numbers == list(range(numbers[0], numbers[0] + len(numbers)))


def test_talker_listener(run):
    """Fig. 8 of ROS-lite2."""
    running = run("talker_listener.yaml")
    heard = [running.wait_for("listener", r"I heard: 'Hello World: (\d+)'") for _ in range(5)]
    assert_consecutive(int(match.group(1)) for match in heard)
    running.stop()
    assert running.places() == {
        "talker": (1, 1),
        "listener": (2, 1),
        "(bridge inward)": (1, 2),
        "(bridge outward)": (1, 3),
    }


@pytest.mark.parametrize("mapfile", ["three_nodes.yaml", "three_nodes.map"])
def test_three_nodes(run, mapfile):
    """Fig. 6 and 7 of ROS-lite: both listeners of cluster 2 hear the talker of cluster 1."""
    running = run(mapfile)
    for _ in range(3):
        running.wait_for("listener", "I heard")
    for _ in range(3):
        running.wait_for("listener2", "I heard")
    running.stop()
    clusters = {node: cluster for node, (cluster, _) in running.places().items()}
    assert clusters == {"talker": 1, "listener": 2, "listener2": 2}


def tick() -> None:
    """Advance the platform's clock by more than a picture's period for each line of input."""
    from rosgraph_msgs.msg import Clock

    with peer_node("clock") as node:
        publisher = node.create_publisher(Clock, "/clock", 1)
        topics = ("/clock", "/camera/image_raw", "/camera/image_inverted")
        spin_until(node, lambda: all(map(node.count_subscribers, topics)))
        announce("all are there")
        for number, _ in enumerate(sys.stdin, start=1):
            seconds, nanoseconds = divmod(150_000_000 * number, 1_000_000_000)
            publisher.publish(Clock(clock=Time(sec=seconds, nanosec=nanoseconds)))


def test_image_pipeline(run, start, tmp_path):
    """Thirty pictures of 1 MiB through three clusters: every byte correct, none lost.

    The source runs on the test's clock, else a delayed node would lose pictures on a busy machine.
    """
    mapfile = yaml.safe_load((MAPFILES / "image_pipeline.yaml").read_text())
    mapfile["launch_path"] = str(MAPFILES / mapfile["launch_path"])
    mapfile["nodes"]["image_source"]["parameters"] = {"use_sim_time": True}
    (tmp_path / "pipeline.yaml").write_text(yaml.safe_dump(mapfile))
    running = run(tmp_path / "pipeline.yaml")
    running.program.wait_for('"started"')  # else the platform would be the clock's
    clock = start(peer_command(tick))
    clock.wait_for("^all are there$")
    for number in range(1, 31):
        clock.say("tick")
        verdict = running.wait_for("image_sink", r"frame (\d+) is (\w+), (\d+) lost")
        assert verdict.groups() == (str(number), "good", "0")
    clock.kill()
    running.stop()


def test_services_and_parameters(run):
    running = run("services_parameters.yaml")
    running.wait_for("controller", r"gain is 0\.5")
    for state in ("on", "off", "on"):
        running.wait_for("lamp_switch", rf"answer: the lamp is {state} \(changed\)")
    running.wait_for("tuner", r"gain 2\.5 was accepted")
    running.wait_for("tuner", r"gain 99\.0 was refused")
    running.wait_until_said("controller", "gain is now 7.5")
    running.stop()
    assert "gain is now 99" not in running.program.output


def test_action(run):
    """Two clients, one in the server's cluster; both cancel every third goal that still runs."""
    running = run("action.yaml")
    running.wait_until_said(
        "near_client", "goal 1 succeeded: [0, 1, 1, 2, 3, 5]", "cancelled: [0, 1"
    )
    running.wait_until_said(
        "far_client",
        "feedback: [0, 1, 1, 2, 3, 5, 8, 13]",  # of any goal: rclpy drops it after the result
        "goal 1 succeeded: [0, 1, 1, 2, 3, 5, 8, 13, 21]",
        "cancelled: [0, 1",
    )
    running.stop()


def test_every_mapfile_is_run_here():
    others = (
        *("test_ndt_replay.py", "test_reference_system.py", "test_ros_lite.py", "test_whill.py"),
    )
    here = (Path(__file__), *(Path(__file__).with_name(other) for other in others))
    tested = {name for file in here for name in re.findall(NAMED, file.read_text())}
    mapfiles = {f.name for f in MAPFILES.iterdir() if f.is_file() and ".params." not in f.name}
    assert mapfiles <= tested
