# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Policies and priorities of a mapfile, with and without the rights to set them."""

from __future__ import annotations

import json
import os
import sys
from pathlib import Path
from typing import Any

import pytest

from rmw_manycore_py.errors import EXIT_BAD_INPUT
from rmw_manycore_py.native import _transport
from rmw_manycore_py.process.scheduling import Scheduling, refusal
from support import IS_MANYCORE
from support.peers.programs import forked_manycore
from support.processes.commands import manycore_command

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="manycore run is about rmw_manycore"),
]

SHOW = "import os; print(os.sched_getscheduler(0), os.sched_getparam(0).sched_priority)"
JOIN_AND_WAIT = """
import rclpy
rclpy.init()
node = rclpy.create_node("waiting")
print("joined", flush=True)
try:
    rclpy.spin(node)
except BaseException:
    pass
"""
# A process without the right to priorities of real time; it needs rights to give that one up.
WITHOUT_RIGHTS = ["prlimit", "--rtprio=0:0"]
if os.geteuid() == 0:
    WITHOUT_RIGHTS += ["setpriv", "--bounding-set=-sys_nice"]


def write(directory: Path, **scheduling: dict[str, object]) -> Path:
    nodes = {
        name: {
            "cluster": 1,
            "core": core,
            "command": [sys.executable, "-c", SHOW],
            "ros_arguments": False,
            **({"scheduling": given} if given else {}),
        }
        for core, (name, given) in enumerate(scheduling.items(), start=1)
    }
    mapfile = directory / "map.yaml"
    mapfile.write_text(json.dumps({"nodes": nodes}))
    return mapfile


@pytest.mark.skipif(
    refusal(Scheduling("fifo", 3)) is not None, reason="this user has no priorities of real time"
)
def test_each_node_has_its_policy_and_the_runner_keeps_its_own(start, tmp_path, platform) -> None:
    mapfile = write(
        tmp_path,
        first={"policy": "fifo", "priority": 3},
        second={},
        third={"policy": "rr", "priority": 2},
        fourth={"policy": "other"},
    )
    run = start(forked_manycore("run", mapfile))
    assert run.wait() == 0
    shown = {line for line in run.lines if " | " in line and not line.startswith("manycore")}
    assert shown == {
        f"first    | {os.SCHED_FIFO} 3",
        f"second   | {os.SCHED_OTHER} 0",
        f"third    | {os.SCHED_RR} 2",
        f"fourth   | {os.SCHED_OTHER} 0",
    }


@pytest.mark.skipif(
    refusal(Scheduling("fifo", 4)) is not None, reason="this user has no priorities of real time"
)
def test_a_receive_thread_is_more_urgent_than_the_nodes_of_its_cluster(
    start, tmp_path, platform
) -> None:
    mapfile = write(tmp_path, urgent={"policy": "rr", "priority": 3}, other={"policy": "other"})
    nodes = json.loads(mapfile.read_text())["nodes"]
    for cluster, node in enumerate(nodes.values(), start=1):
        node["cluster"] = cluster
        node["command"] = [sys.executable, "-c", JOIN_AND_WAIT]
    mapfile.write_text(json.dumps({"nodes": nodes}))
    run = start(forked_manycore("run", mapfile))
    for _ in nodes:
        run.wait_for("joined")
    with _transport.Platform(platform) as view:
        pids = {one.id: one.receive_thread_pid for one in view.clusters()}
    found = {
        cluster: (os.sched_getscheduler(pid), os.sched_getparam(pid).sched_priority)
        for cluster, pid in pids.items()
        if pid
    }
    assert found == {1: (os.SCHED_FIFO, 4), 2: (os.SCHED_OTHER, 0)}


FORBIDDEN: Any = {"plain": {}, "real": {"policy": "fifo", "priority": 30}}


def test_what_limits_forbid_is_refused_before_anything_starts(start, tmp_path) -> None:
    mapfile = write(tmp_path, **FORBIDDEN)
    run = start([*WITHOUT_RIGHTS, *manycore_command("run", mapfile)])
    assert run.wait() == EXIT_BAD_INPUT
    assert "'real': scheduling fifo 30 is not allowed (limit rtprio: 0)" in run.output
    assert "rtprio 30' to /etc/security/limits.conf" in run.output
    assert "started" not in run.output


def test_what_limits_forbid_is_shown(start, tmp_path) -> None:
    mapfile = write(tmp_path, **FORBIDDEN)
    show = start([*WITHOUT_RIGHTS, *manycore_command("map", "show", mapfile)])
    assert show.wait() == 0
    assert "notice: 'real' cannot run here: scheduling fifo 30 is not allowed" in show.output
    assert any(line.split() == ["/real", "scheduling", "fifo", "30"] for line in show.lines)
    doctor = start([*WITHOUT_RIGHTS, *manycore_command("doctor")])
    doctor.wait()
    assert "real-time scheduling: not allowed" in doctor.output
