# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The wheelchair is driven from Fast DDS by ten nodes on the platform, also after faults.

Driving quality is not tested here: it depends on the machine; see `manycore bench whill`.
"""

from __future__ import annotations

import json
import shlex
import signal
from pathlib import Path
from typing import Any

import pytest
import yaml

from support import IS_MANYCORE, TIMEOUT_S
from support.processes.commands import manycore_command
from support.sources.advice import quoted, run_quoted

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="the bridge is part of rmw_manycore"),
]

LONG_S = 6 * TIMEOUT_S
SHORT = ("--length", "30", "--turn-radius", "4", "--turn-speed", "1.5")


@pytest.fixture(scope="module")
def course(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the directory of a course of 30 m."""
    from click.testing import CliRunner

    from rmw_manycore_py.cli.main import cli

    directory = tmp_path_factory.mktemp("course")
    result = CliRunner().invoke(cli, ["whill", "course", str(directory), *SHORT])
    assert result.exit_code == 0, result.output
    return directory


def driven(start: Any, course: Path, *options: str) -> dict[str, Any]:
    """Return the figures of a drive; "said" is its output."""
    drive = start(manycore_command("whill", "drive", "--course", course, "--json", *options))
    assert drive.wait(LONG_S) == 0, drive
    head, _, figures = drive.output.partition("\n{\n")
    return {**json.loads("{" + figures), "said": head}


@pytest.mark.stress
def test_the_same_drive_again_in_virtual_time(start, course) -> None:
    """The laptop is a node of the run; the end has the vehicle's place to a micrometre."""
    ends = []
    for _ in range(2):
        drive = ("run", course / "whill_virtual.yaml", "--virtual", "--instant")
        run = start(manycore_command(*drive, "--duration", "60"))
        ends.append(run.wait_for("arrived, after .*", LONG_S).group())
        assert run.wait() == 0
    assert ends[0] == ends[1]


@pytest.mark.long
def test_the_gate_dies_and_the_vehicle_drives_on_until_the_lidar_stops(start, platform, course):
    """The vehicle stands while no command passes, and is engaged again; without pose it stops."""
    options = ("--run", "--timeout", str(LONG_S), "--duration", "20")
    faults = ("--fault", "vehicle_cmd_gate@3", "--fault", "lidar@12")
    figures = driven(start, course, *options, *faults)
    assert figures["driven_m"] > 1.0
    assert figures["lateral_m_max"] < 1.0
    assert figures["scans"] > 0
    gate, _ = figures["faults"]
    assert gate["was_restarted"]
    assert any("vehicle_cmd_gate is gone" in text for text in gate["named_by"])
    assert gate["stood_s"] is not None
    assert "simple_trajectory_follower: the standard deviation of the position" in figures["said"]
    assert figures["stands"] >= 2


@pytest.mark.stress
def test_the_wheels_stop(start, platform, course):
    """Without a twist the vehicle stops on its way."""
    options = ("--run", "--timeout", str(LONG_S), "--duration", "15")
    figures = driven(start, course, *options, "--fault", "wheels@1")
    assert "simple_trajectory_follower: the standard deviation of the speed" in figures["said"]
    assert figures["stands"] >= 1


@pytest.mark.long
def test_without_a_first_pose_the_vehicle_stands(start, platform, course, tmp_path):
    """Only the nodes that drive run on the platform, none that estimates a pose."""
    mapfile = yaml.safe_load((course / "whill.yaml").read_text())
    names = ("static_trajectory_publisher", "simple_trajectory_follower", "whill_interface")
    nodes = {name: mapfile["nodes"][name] for name in names}
    for file in ("map.npz", "trajectory.csv", "streets.npz"):
        (tmp_path / file).symlink_to(course / file)
    (tmp_path / "whill.yaml").write_text(yaml.safe_dump({**mapfile, "nodes": nodes}))
    enough = ("--timeout", "20")  # for the nodes to come up
    drive = start(manycore_command("whill", "drive", "--course", tmp_path, "--run", *enough))
    assert drive.wait(LONG_S) == 1
    assert "follower: waiting for input/kinematics: no command is published" in drive.output
    assert "/initialpose has no subscription, so no initial pose was sent" in drive.output


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupted_drive_leaves_nothing(start, platform, course, number):
    drive = start(manycore_command("whill", "drive", "--course", course, "--run"))
    drive.wait_for("waiting for", LONG_S)
    drive.signal(number)
    assert drive.wait(LONG_S) == 130
    assert "Traceback" not in drive.output


@pytest.mark.long
def test_neither_course_nor_stack(start, platform, tmp_path):
    """The errors name the commands that make the one and start the other."""
    course = tmp_path / "the user's course"
    drive = ("whill", "drive", "--course", course)
    no_course = start(manycore_command(*drive))
    assert no_course.wait(LONG_S) == 2
    run_quoted(no_course.output, "manycore whill course")
    streets = (course / "streets.npz").rename(tmp_path / "streets.npz")
    (course / "streets.npz").write_text("no streets")
    no_streets = start(manycore_command(*drive))
    assert no_streets.wait(LONG_S) == 2
    assert quoted(no_streets.output) == quoted(no_course.output)
    streets.rename(course / "streets.npz")
    no_stack = start(manycore_command(*drive, "--timeout", "1"))
    assert no_stack.wait(LONG_S) == 1
    assert "nothing publishes /whill/controller/cmd_vel; start the stack first" in no_stack.output
    (command,) = quoted(no_stack.output)
    stack = start(manycore_command(*shlex.split(command)[1:]))
    assert driven(start, course, "--timeout", str(LONG_S), "--duration", "2")["driven_m"] > 0
    assert stack.stop() == 0, stack


def test_a_trajectory_that_cannot_be_driven_ends_the_run(start, platform, course, tmp_path):
    """The publisher of trajectories reports the line; its restarts fail, too."""
    mapfile = yaml.safe_load((course / "whill.yaml").read_text())
    name = "static_trajectory_publisher"
    node = mapfile["nodes"][name]
    node["respawn"] = {"delay": 0.01, "max_retries": 1}
    (tmp_path / "trajectory.csv").write_text("x_m,y_m,yaw_rad,speed_m_s\n0,0,0,1\n5,0,0,1\n")
    (tmp_path / "whill.yaml").write_text(yaml.safe_dump({**mapfile, "nodes": {name: node}}))
    run = start(manycore_command("run", tmp_path / "whill.yaml"))
    assert run.wait(LONG_S) == 1
    assert "trajectory.csv:2: expected the next point between 0.001 and 2 m away" in run.output
