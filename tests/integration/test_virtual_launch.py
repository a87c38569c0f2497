# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Delays of launch files, and what waits for other processes, count in virtual time."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from support import IS_MANYCORE
from support.nodes import timed

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="manycore is about rmw_manycore"),
]

START_NS = 10**18
MS = 10**6
LAUNCH = f"""\
from launch import LaunchDescription
from launch.actions import ExecuteProcess, RegisterEventHandler, TimerAction
from launch.event_handlers import OnProcessExit, OnProcessStart

def process(name, kind):
    command = ["{sys.executable}", "{timed.__file__}", kind]
    return ExecuteProcess(cmd=command, name=name, additional_env={{"{timed.BIRTHS}": "/dev/null"}})

def later(period, name):
    return [TimerAction(period=period, actions=[process(name, "victim")])]

def generate_launch_description():
    tool, late = process("tool", "tool"), process("late", "victim")
    return LaunchDescription([
        RegisterEventHandler(OnProcessExit(target_action=tool, on_exit=later(0.2, "last"))),
        RegisterEventHandler(OnProcessStart(target_action=late, on_start=later(0.05, "next"))),
        TimerAction(period=0.35, actions=[late]),
        tool,
    ])
"""


def test_delays_count_in_virtual_time(tmp_path: Path, log_of) -> None:
    (tmp_path / "demo.launch.py").write_text(LAUNCH)
    mapfile = tmp_path / "map.yaml"
    names = ("tool", "late", "next", "last")
    nodes = "".join(f"  {name}: {{cluster: {at % 2 + 1}}}\n" for at, name in enumerate(names))
    mapfile.write_text(f"platform: coolidge\nlaunch_path: demo.launch.py\nnodes:\n{nodes}")
    log = log_of(mapfile, 1.6)
    births = {
        name: int(line.split()[1]) - START_NS
        for name, lines in log.items()
        for line in lines
        if line.startswith("born")
    }
    assert births == {"late": 350 * MS, "next": 400 * MS, "last": 1200 * MS}
