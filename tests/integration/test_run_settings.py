# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What nodes get under `manycore run`: parameters, texts, CPU, scheduling."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

import rmw_manycore_py as manycore
from rmw_manycore_py.errors import EXIT_BAD_INPUT
from support import IS_MANYCORE, wait_until
from support.peers.programs import forked_manycore
from support.processes.commands import manycore_command
from support.processes.program import Program
from support.samples.entry_points import write_entry_point

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="manycore run is about rmw_manycore"),
]

CPUS, NICE = sorted(os.sched_getaffinity(0)), os.nice(0)
PROBE = """\
#!{python}
import os
import rclpy
rclpy.init()
node = rclpy.create_node("own")
values = {{name: one.value for name, one in sorted(node._parameter_overrides.items())}}
print("has", values, flush=True)
policies = {{os.SCHED_OTHER: "other", os.SCHED_BATCH: "batch"}}
policy = policies[os.sched_getscheduler(0)]
print("on", *os.sched_getaffinity(0), policy, "nice", os.nice(0), flush=True)
"""
TEXTS = ("on", "No", "0o17", "017", "1_000", "1e3", "1.50", "1:30", "2026-01-01", "2026-13-45")
Run = Callable[[str, str], Program]


@pytest.fixture
def run(start, tmp_path: Path, platform: str) -> Run:
    """Return the run of a launch file whose nodes print what they get."""
    program = tmp_path / "prefix/lib/demo/probe"
    index = tmp_path / "prefix/share/ament_index/resource_index/packages"
    for directory in (program.parent, index):
        directory.mkdir(parents=True)
    (index / "demo").touch()
    program.write_text(PROBE.format(python=sys.executable))
    program.chmod(0o755)

    def run_nodes(nodes: str, mapfile: str) -> Program:
        text = nodes.replace("<node", '<node pkg="demo" exec="probe"')
        (tmp_path / "demo.launch.xml").write_text(f"<launch>{text}</launch>")
        (tmp_path / "map.yaml").write_text(f"launch_path: demo.launch.xml\nnodes:\n{mapfile}")
        command = forked_manycore("run", tmp_path / "map.yaml")
        return start(command, AMENT_PREFIX_PATH=str(tmp_path / "prefix"))

    return run_nodes


def test_texts_of_a_mapfile_reach_a_program_as_they_are_written(start, tmp_path, platform) -> None:
    launch = "<launch><arg name='given'/><executable name='two' cmd='echo $(var given)'/></launch>"
    (tmp_path / "two.launch.xml").write_text(launch)
    text = ", ".join(TEXTS)
    show = "import os, sys; print(*sys.argv[1:], os.environ['A'], os.environ['B'])"
    one = f"command: [python3, -c, {show!r}, {text}], arguments: [{text}], ros_arguments: false"
    mapfile = tmp_path / "map.yaml"
    mapfile.write_text(
        "launch_path: two.launch.xml\nlaunch_arguments: {given: 0x1F}\nnodes:\n"
        f"  one: {{cluster: 1, {one}, env: {{A: yes, B: 017}}}}\n  two: {{cluster: 1}}\n"
    )
    running = start(forked_manycore("run", mapfile))
    assert running.wait() == 0, running
    assert f"one      | {' '.join([*TEXTS, *TEXTS])} yes 017" in running.lines
    assert "two      | 0x1F" in running.lines
    mapfile.write_text("nodes:\n  one: {cluster: 1, command: [echo, ~], ros_arguments: false}\n")
    refused = start(forked_manycore("run", mapfile))
    assert refused.wait() == EXIT_BAD_INPUT
    assert "nodes.one.command: expected a string or a number, found nothing" in refused.output


def test_a_node_gets_the_parameters_that_the_placement_shows(run: Run, tmp_path: Path) -> None:
    file = tmp_path / "p.yaml"
    file.write_text(
        "/**: {ros__parameters: {a: 1, b: 1, c: 1, d: 1}}\n"
        "/ns/*: {ros__parameters: {b: $(eval '1 + 1'), c: 2, d: 2}}\n"
    )
    running = run(
        f'<node name="one" namespace="ns"><param from="{file}" allow_substs="true"/>'
        '<param name="c" value="3"/></node>',
        "  /ns/one: {cluster: 1, parameters: {d: 4}}\n",
    )
    running.wait_for(r"has \{'a': 1, 'b': 2, 'c': 3, 'd': 4\}$")
    assert running.wait() == 0


def test_a_prefix_that_pins_does_not_move_a_node_of_the_mapfile(run: Run) -> None:
    elsewhere = f"taskset --cpu-list {CPUS[-1]}"
    running = run(
        f'<node name="one" launch-prefix="{elsewhere}"/>'
        '<node name="two" launch-prefix="chrt --batch 0"/>'
        '<node name="three" launch-prefix="chrt --batch 0 nice -n 5"/>',
        f"  one: {{cluster: 1, host_cpu: {CPUS[0]}}}\n"
        f"  two: {{cluster: 1, host_cpu: {CPUS[0]}, scheduling: {{policy: other}}}}\n"
        f"  three: {{cluster: 1, host_cpu: {CPUS[0]}}}\n",
    )
    running.wait_for(rf"overrules the prefix '{elsewhere}' of 'one': host CPU {CPUS[0]}$")
    running.wait_for(rf"of 'two': host CPU {CPUS[0]}, scheduling other$")
    assert running.wait() == 0
    printed = [line.partition(" | ")[::2] for line in running.lines]
    places = {name.strip(): text for name, text in printed if text.startswith("on ")}
    assert places == {
        "one": f"on {CPUS[0]} other nice {NICE}",
        "two": f"on {CPUS[0]} other nice {NICE}",
        "three": f"on {CPUS[0]} batch nice {min(NICE + 5, 19)}",
    }


def test_an_entry_point_is_shown_by_package_and_executable(
    start: Callable[..., Program], tmp_path: Path, platform: str
) -> None:
    write_entry_point(tmp_path)
    mapfile = tmp_path / "map.yaml"
    mapfile.write_text("nodes:\n  eye: {cluster: 1, package: my_robot, executable: detector}\n")
    run = start(manycore_command("run", mapfile), PYTHONPATH=str(tmp_path))
    run.wait_for("eye started")
    wait_until(
        lambda: "my_robot detector" in {p.program for p in manycore.status(platform).processes},
        "the node runs",
    )
    assert run.stop() == 0
